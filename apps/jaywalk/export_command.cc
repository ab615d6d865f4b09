#include <cstdio>
#include <string>

#include "apps/formats/run_exporter.h"
#include "apps/jaywalk/commands.h"
#include "apps/jaywalk/progress.h"
#include "apps/why/recorded_run.h"
#include "hal/types/errors.h"

namespace jaywalk {
namespace {

struct ExportOptions {
  std::filesystem::path run;  ///< a run's folder, or a recording.jwr
  std::filesystem::path out;  ///< empty: run.mcap in the run's folder
};

ExportOptions export_options;

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

std::filesystem::path place_of(const RecordedRun& run) {
  return run.is_in_parts() ? run.file() : run.file().parent_path();
}

int run_export(const ExportOptions& options) {
  RecordedRun run(options.run);
  const std::filesystem::path out = options.out.empty() ? place_of(run) / "run.mcap" : options.out;
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
  CLI::App* command = app.add_subcommand("export", "A run's recording as MCAP, for Foxglove and ros2 bag");
  command->add_option("run", export_options.run, "A run's folder, or its recording.jwr")->required();
  command->add_option("--out", export_options.out, "File to write (default: run.mcap in the run's folder)");
  command->callback([&exit_code] { exit_code = run_export(export_options); });
}

}  // namespace jaywalk
