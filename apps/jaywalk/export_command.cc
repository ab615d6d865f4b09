#include <cstdio>
#include <string>

#include "apps/formats/run_exporter.h"
#include "apps/jaywalk/commands.h"
#include "apps/jaywalk/progress.h"
#include "apps/why/recorded_run.h"
#include "hal/types/errors.h"

namespace jaywalk {
namespace {

void export_all(RecordedRun& run, RunExporter& exporter) {
  SeenRun again(run);
  Progress progress;
  while (again.step()) {
    exporter.add(again.last(), again.tracker());
    if (progress.is_due()) progress.show(run.share_read(), std::to_string(exporter.file().messages()) + " messages");
  }
  progress.make_way();
  std::fputs(again.remarks().c_str(), stderr);
}

/// `folder`: a run's, or a recording.jwr; `wanted`: the file to write; empty: run.mcap in the run's folder.
int run_export(const std::filesystem::path& folder, const std::filesystem::path& wanted) {
  RecordedRun run(folder);
  const std::filesystem::path place = run.is_in_parts() ? run.file() : run.file().parent_path();
  const std::filesystem::path out = wanted.empty() ? place / "run.mcap" : wanted;
  std::error_code missing;
  if (std::filesystem::equivalent(run.file(), out, missing))
    throw StartupError(run.file().string() + ": would be overwritten", "choose another --out");
  RunExporter exporter(out, run.setup());
  export_all(run, exporter);
  exporter.finish(run.is_in_parts() ? std::filesystem::path() : run.file());
  std::printf("%s: %llu messages on %zu topics over %.1f s\n", out.c_str(),
              static_cast<unsigned long long>(exporter.file().messages()), exporter.file().topics().size(),
              static_cast<double>(exporter.file().last_ns() - exporter.file().first_ns()) * 1e-9);
  return 0;
}

}  // namespace

void add_export(CLI::App& app, int& exit_code) {
  static std::filesystem::path run, out;
  CLI::App* command = app.add_subcommand("export", "A run's recording as MCAP, for Foxglove and ros2 bag");
  command->add_option("run", run, "A run's folder, or its recording.jwr")->required();
  command->add_option("--out", out, "File to write (default: run.mcap in the run's folder)");
  command->callback([&exit_code] { exit_code = run_export(run, out); });
}

}  // namespace jaywalk
