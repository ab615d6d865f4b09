#include <cstdio>
#include <string>

#include "apps/campaign/campaign_folder.h"
#include "apps/campaign/report.h"
#include "apps/jaywalk/commands.h"
#include "apps/report/drive_metrics.h"
#include "hal/types/errors.h"

namespace jaywalk {
namespace {

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
  for (std::size_t k = 0; k < page.failures.size(); ++k) {
    const std::string& svg = page.failures[k].svg;
    if (!svg.empty()) campaign::write_whole(out / "failures" / (std::to_string(k + 1) + ".svg"), svg, kBegun);
  }
  campaign::write_whole(out / "report.md", campaign::markdown_of(page), kBegun);
  campaign::write_whole(out / "report.html", campaign::html_of(page), kBegun);
}

/// `wanted`: folder of a campaign's report; empty: "report" in the first folder.
int run_report(const std::vector<std::filesystem::path>& folders, const std::filesystem::path& wanted) {
  if (folders.size() == 1 && !campaign::is_campaign(folders.front())) {
    std::fputs(run_words(folders.front()).c_str(), stdout);
    return 0;
  }
  const campaign::ReportPage page = campaign::page_of(folders);
  const std::filesystem::path out = wanted.empty() ? folders.front() / "report" : wanted;
  save(page, out);
  if (page.missing > 0)
    std::fprintf(stderr, "jaywalk: %zu runs are missing; the campaign's command goes on with them\n", page.missing);
  std::printf("See %s and %s\n", (out / "report.html").c_str(), (out / "report.md").c_str());
  return page.missing > 0 ? 1 : 0;
}

}  // namespace

void add_report(CLI::App& app, int& exit_code) {
  static std::vector<std::filesystem::path> folders;
  static std::filesystem::path out;
  CLI::App* command = app.add_subcommand("report", "A run in plain words, or a campaign's tables, charts and failures");
  command->add_option("folders", folders, "A run's folder, or those of a campaign's shards")->required();
  command->add_option("--out", out, "Folder of a campaign's report (default: report in the first)");
  command->callback([&exit_code] { exit_code = run_report(folders, out); });
}

}  // namespace jaywalk
