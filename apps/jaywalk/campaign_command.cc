#include <sched.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <thread>
#include <vector>

#include "apps/campaign/campaign.h"
#include "apps/campaign/campaign_folder.h"
#include "apps/campaign/report.h"
#include "apps/jaywalk/commands.h"
#include "apps/jaywalk/progress.h"
#include "apps/report/drive_metrics.h"
#include "hal/shown_text.h"
#include "hal/types/errors.h"

namespace jaywalk {
namespace {

struct CampaignOptions {
  std::filesystem::path file;
  std::filesystem::path out = "out/campaign";
  int jobs = 0;  ///< runs at a time; 0: as many as this process may use processors
  campaign::Shard shard;
};

using campaign::Keep;
using campaign::PlannedRun;
using campaign::RunResult;

constexpr std::chrono::milliseconds kBetweenLooks{20};

int processors() {
  cpu_set_t may{};
  return ::sched_getaffinity(0, sizeof may, &may) == 0 ? std::max(1, CPU_COUNT(&may)) : 1;
}

std::filesystem::path own_program() {
  std::error_code error;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
  if (error) throw StartupError("/proc/self/exe: " + error.message(), "mount /proc");
  return program;
}

/// "8 s", "12 min", "3.5 h".
std::string time_in_words(double seconds) {
  if (seconds < 90.0) return formatted("%.0f s", seconds);
  return seconds < 5400.0 ? formatted("%.0f min", seconds / 60.0) : formatted("%.1f h", seconds / 3600.0);
}

/// Counts what is done and tells it: a bar on a terminal, a line a run elsewhere.
class Teller {
 public:
  Teller(std::size_t all, std::size_t finished) : all_(all), before_(finished), finished_(finished) {}

  void finished(const PlannedRun& run, const RunResult& result) {
    ++finished_;
    if (!result.success) ++failed_;
    if (bar_.is_seen()) return show();
    std::printf("%zu of %zu: %s: %s%s%s; %s left\n", finished_, all_, run.folder.c_str(), result.outcome.c_str(),
                result.reason.empty() ? "" : ": ", result.reason.c_str(), left().c_str());
    std::fflush(stdout);
  }
  void show() {
    if (!bar_.is_due() || all_ == 0) return;
    const std::string words = std::to_string(finished_) + " of " + std::to_string(all_) + ", " +
                              std::to_string(failed_) + " failed, " + left() + " left";
    bar_.show(static_cast<double>(finished_) / static_cast<double>(all_), words);
  }

 private:
  [[nodiscard]] std::string left() const {
    const double took_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - began_).count();
    const std::size_t done = finished_ - before_;
    return done == 0 ? "?" : time_in_words(took_s * static_cast<double>(all_ - finished_) / static_cast<double>(done));
  }

  std::size_t all_, before_, finished_, failed_ = 0;
  std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
  Progress bar_;
};

/// One share of a campaign, from what is left of it to nothing.
class Share {
 public:
  Share(const CampaignOptions& options, const campaign::Campaign& campaign, const campaign::Plan& plan)
      : keep_(campaign.keep),
        runs_(plan.runs),
        folder_(std::filesystem::absolute(options.out), campaign::plan_text(campaign, plan, own_program()),
                options.shard),
        pool_(own_program(), campaign.file.has_parent_path() ? campaign.file.parent_path() : "."),
        jobs_(static_cast<std::size_t>(options.jobs > 0 ? options.jobs : processors())) {
    for (std::size_t k = 0; k < runs_.size(); ++k) {
      if (!options.shard.has(k)) continue;
      ++all_;
      if (!folder_.is_finished(runs_[k]))
        left_.push_back(k);
      else if (!folder_.result(runs_[k]).ran())
        ++not_run_;
    }
  }

  /// Returns 0 where nothing is left; else the exit code of what stopped it.
  int run() {
    Teller teller(all_, all_ - left_.size());
    const Interruption interruption;
    for (std::size_t next = 0; next < left_.size() || pool_.size() > 0;) {
      for (; next < left_.size() && pool_.size() < jobs_; ++next)
        pool_.start(left_[next], runs_[left_[next]], folder_.begin(runs_[left_[next]]));
      if (interruption.came() || !take_ended(teller)) {
        for (const std::size_t index : pool_.kill_all()) folder_.drop(runs_[index]);
        return interruption.came() ? interruption.exit_code() : 1;
      }
      teller.show();
      std::this_thread::sleep_for(kBetweenLooks);
    }
    return 0;
  }
  [[nodiscard]] std::size_t not_run() const { return not_run_; }

 private:
  /// False where a run was stopped from outside: it is not finished, and the campaign is to stop as well.
  bool take_ended(Teller& teller) {
    while (const auto ended = pool_.ended()) {
      const PlannedRun& run = runs_[ended->run];
      const RunResult result = campaign::result_of(run, folder_.work(run), ended->status);
      if (result.outcome == "interrupted") return folder_.drop(run), false;
      folder_.finish(run, result, keep_);
      if (!result.ran()) ++not_run_;
      teller.finished(run, result);
    }
    return true;
  }

  Keep keep_;
  const std::vector<PlannedRun>& runs_;
  campaign::CampaignFolder folder_;
  campaign::RunPool pool_;
  std::size_t jobs_, all_ = 0, not_run_ = 0;
  std::vector<std::size_t> left_;
};

int run_campaign(const CampaignOptions& options) {
  const campaign::Campaign campaign = campaign::load_campaign(options.file);
  const campaign::Plan plan = campaign::plan_of(campaign);
  Share share(options, campaign, plan);
  if (const int stopped = share.run(); stopped != 0) {
    std::fprintf(stderr, "jaywalk: stopped; the same command goes on with what is left\n");
    return stopped;
  }
  if (share.not_run() > 0)
    std::fprintf(stderr, "jaywalk: %zu runs crashed or were refused; the report names them\n", share.not_run());
  std::printf("finished; see it with jaywalk report %s\n", options.out.c_str());
  return share.not_run() > 0 ? 1 : 0;
}

/// "2/4": the second of four. Throws StartupError for what is none.
campaign::Shard shard_from(const std::string& word) {
  const std::size_t slash = std::min(word.find('/'), word.size() - 1);
  const auto part = number_in<std::size_t>(word.substr(0, slash)), of = number_in<std::size_t>(word.substr(slash + 1));
  if (part && of && *part >= 1 && *part <= *of) return {*part, *of};
  throw StartupError("--shard: " + shown(word) + " is no share", "give I/N, 1/4 to 4/4 say");
}

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
      campaign::write_whole(out / "charts" / (chart.name + ".svg"), chart.svg);
  for (std::size_t k = 0; k < page.failures.size(); ++k) {
    const std::string& svg = page.failures[k].svg;
    if (!svg.empty()) campaign::write_whole(out / "failures" / (std::to_string(k + 1) + ".svg"), svg);
  }
  campaign::write_whole(out / "report.md", campaign::markdown_of(page));
  campaign::write_whole(out / "report.html", campaign::html_of(page));
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

void add_campaign(CLI::App& app, int& exit_code) {
  static CampaignOptions options;
  CLI::App* command = app.add_subcommand("campaign", "Many simulated runs, as one experiment that can be interrupted");
  command->add_option("campaign", options.file, "Campaign file (TOML; docs/how-to/campaigns.md)")->required();
  command->add_option("--jobs", options.jobs, "Runs at a time (default: all processors)")->check(CLI::Range(1, 4096));
  command
      ->add_option_function<std::string>(
          "--shard", [](const std::string& word) { options.shard = shard_from(word); },
          "The I-th of N shares of the runs alone")
      ->type_name("I/N");
  command->add_option("--out", options.out, "Folder for the runs; shares may have one in common")
      ->capture_default_str();
  command->callback([&exit_code] { exit_code = run_campaign(options); });
}

void add_report(CLI::App& app, int& exit_code) {
  static std::vector<std::filesystem::path> folders;
  static std::filesystem::path out;
  CLI::App* command = app.add_subcommand("report", "A run in plain words, or a campaign's tables, charts and failures");
  command->add_option("folders", folders, "A run's folder, or those of a campaign's shards")->required();
  command->add_option("--out", out, "Folder of a campaign's report (default: report in the first)");
  command->callback([&exit_code] { exit_code = run_report(folders, out); });
}

}  // namespace jaywalk
