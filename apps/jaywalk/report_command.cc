#include <cstdio>
#include <string>

#include "apps/campaign/campaign_folder.h"
#include "apps/campaign/report.h"
#include "apps/jaywalk/commands.h"
#include "apps/report/drive_metrics.h"
#include "hal/types/errors.h"

namespace jaywalk {
namespace {

struct ReportOptions {
  std::vector<std::filesystem::path> folders;
  std::filesystem::path out;  ///< of a campaign's report; empty: "report" in the first folder
};

ReportOptions report_options;

constexpr const char* kBegun = "begun";

/// Empty: pictures of an earlier report may not stand beside this one's.
void make_empty(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::remove_all(folder, error);
  if (!error) std::filesystem::create_directories(folder, error);
  if (error) throw StartupError(folder.string() + ": " + error.message(), "give --out a folder that can be written");
}

void save(const campaign::ReportPage& page, const std::filesystem::path& out) {
  make_empty(out / "charts");
  make_empty(out / "failures");
  for (const campaign::ReportSection& section : page.sections)
    for (const campaign::ReportChart& chart : section.charts)
      campaign::write_whole(out / "charts" / (chart.name + ".svg"), chart.svg, kBegun);
  std::size_t number = 0;
  for (const campaign::ReportFailure& failure : page.failures) {
    ++number;
    const std::filesystem::path picture = out / "failures" / (std::to_string(number) + ".svg");
    if (!failure.svg.empty()) campaign::write_whole(picture, failure.svg, kBegun);
  }
  campaign::write_whole(out / "report.md", campaign::markdown_of(page), kBegun);
  campaign::write_whole(out / "report.html", campaign::html_of(page), kBegun);
}

int run_report(const ReportOptions& options) {
  if (options.folders.size() == 1 && !campaign::is_campaign(options.folders.front())) {
    std::fputs(run_words(options.folders.front()).c_str(), stdout);
    return 0;
  }
  const campaign::CampaignReport report(options.folders);
  const std::filesystem::path out = options.out.empty() ? options.folders.front() / "report" : options.out;
  save(report.page(), out);
  if (report.missing() > 0)
    std::fprintf(stderr, "jaywalk: %zu runs are missing; the campaign's command goes on with them\n", report.missing());
  std::printf("See %s and %s\n", (out / "report.html").c_str(), (out / "report.md").c_str());
  return report.missing() > 0 ? 1 : 0;
}

}  // namespace

void add_report(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("report", "A run in plain words, or a campaign's tables, charts and failures");
  command->add_option("folders", report_options.folders, "A run's folder, or those of a campaign's shards")->required();
  command->add_option("--out", report_options.out, "Folder of a campaign's report (default: report in the first)");
  command->callback([&exit_code] { exit_code = run_report(report_options); });
}

}  // namespace jaywalk
