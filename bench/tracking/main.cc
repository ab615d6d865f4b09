// Scores what a run believed against what was there. docs/explanation/results.md#tracking-and-poses has the commands
// behind its figures.
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>

#include "bench/command_line.h"
#include "bench/tracking/run_folder.h"
#include "bench/tracking/track_score.h"
#include "hal/types/errors.h"

namespace jaywalk::bench {
namespace {
struct Options {
  std::string folder, labels, reference;
  std::vector<double> laser_mount{0.0, 0.0, 0.0};
  double between_s = 0.0, late_s = 0.0;
  bool nobody = false;
  ScoreRules rules;
  ViewRule view;

  [[nodiscard]] bool simulated() const { return !nobody && labels.empty() && reference.empty(); }
};

void row(const char* what, double value, const char* unit) {
  if (!std::isnan(value)) std::printf("| %-44s | %10.3f | %-5s |\n", what, value, unit);
}
void row(const char* what, std::size_t value) { std::printf("| %-44s | %10zu |       |\n", what, value); }

void head(const char* what) { std::printf("| %-44s | %10s | %-5s |\n|---|---|---|\n", what, "", ""); }

void print(const char* who, const TrackScore& score, double minutes) {
  head(who);
  row("targets in view, all frames", score.targets());
  row("found", score.matches());
  if (score.targets() > 0)
    row("recall", 100.0 * static_cast<double>(score.matches()) / static_cast<double>(score.targets()), "%");
  row("missed", score.misses());
  row("false positives", score.false_positives());
  row("identity switches", score.switches());
  row("of these of targets found a second before", score.quick_switches());
  row("MOTA", 100.0 * score.mota(), "%");
  row("MOTP, mean distance", score.motp_m(), "m");
  row("velocity RMSE of tracks older than 1 s", score.velocity_rmse_mps(), "m/s");
  row("steady targets' velocity off by over 0.3 m/s", 100.0 * score.steady_wrong(), "%");
  row("steady targets within the claimed 95 %", 100.0 * score.covered(), "%");
  row("found within 0.6 s of moving in view", 100.0 * score.found_soon(), "%");
  row("the same, times hidden or standing counted", 100.0 * score.found_soon_by_clock(), "%");
  row("false moving tracks a minute", static_cast<double>(score.false_movers()) / minutes, "");
  std::printf("\n");
}

void print(const char* what, const std::vector<PosePair>& poses) {
  const RelativeError error = relative_error(poses, 10.0, 1.0);
  if (error.stretches == 0) return;
  head(what);
  row("stretches of 10 m", error.stretches);
  row("translation, median", error.translation_percent, "%");
  row("heading, median", error.heading_deg, "deg");
  std::printf("\n");
}

void print(const Innovations& innovations) {
  if (innovations.count() == 0) return;
  head("innovations of tracks that move");
  row("how many", innovations.count());
  row("normalised and squared, mean; 2 is right", innovations.mean(), "");
  row("95 % bounds of that: 2 and 2 less or more", innovations.mean_bound(), "");
  row("within their own 95 % bound", 100.0 * innovations.share_within_95(), "%");
  std::printf("\n");
}

void frames(const Options& o, const RunFolder& run, const FrameSink& frame) {
  if (o.nobody) {
    for (const double t_s : run.track_times()) frame(t_s, {});
  } else if (!o.labels.empty()) {
    const Pose2 robot_from_laser{o.laser_mount[0], o.laser_mount[1], o.laser_mount[2]};
    labelled_frames(o.labels, run, {robot_from_laser, o.between_s, o.late_s}, frame);
  } else if (o.simulated()) {
    simulated_frames(o.folder, run, o.view, frame);
  }
}

/// NaN lies outside too.
void require_within(const char* option, double value, double least, double most) {
  if (value >= least && value <= most) return;
  throw StartupError(formatted("%s: %g is outside %g to %g", option, value, least, most), "see --help for what it is");
}

void check(const Options& o) {
  if (o.nobody && !(o.labels.empty() && o.reference.empty())) {
    throw StartupError(std::string(o.labels.empty() ? "--reference" : "--labels") + ": --nobody goes alone",
                       "score one after the other");
  }
  require_within("--match", o.rules.match_m, 0.01, 10.0);
  require_within("--range", o.view.range_m, 0.1, 1000.0);
  require_within("--radius", o.view.radius_m, 0.01, 5.0);
  require_within("--between", o.between_s, 0.0, 60.0);
  require_within("--labels-late", o.late_s, 0.0, 10.0);
  for (const double part : o.laser_mount) require_within("--laser-mount", part, -100.0, 100.0);
}

void score(const Options& o) {
  check(o);
  const RunFolder run(o.folder);
  if (o.simulated() && !run.has_truth()) {
    throw StartupError(o.folder + ": nobody knows the truth here", "a replay needs --nobody, --labels or --reference");
  }
  ScoreRules as_it_is = o.rules;
  as_it_is.as_it_is = true;
  TrackScore moving(o.rules), any(o.rules), right(as_it_is);
  std::size_t there = 0;
  frames(o, run, [&](double t_s, const std::vector<Target>& targets) {
    there += targets.size();
    moving.add(t_s, targets, run.tracks_at(t_s, true));
    any.add(t_s, targets, run.tracks_at(t_s, false));
    right.add(t_s, targets, run.tracks_at(t_s, false));
  });
  // Beams end on the edges of wide movers, farther from their middles than narrower ones reach.
  if (o.simulated() && there > 0 && moving.targets() == 0)
    std::fprintf(stderr, "jaywalk_track_bench: no mover was ever in view; are they as wide as --radius %g says?\n",
                 o.view.radius_m);
  if (o.reference.empty()) print("tracks that move", moving, run.minutes());
  if (any.targets() > 0) print("all tracks; standing ones are no error", any, run.minutes());
  if (o.simulated()) print("who walks by tracks that move, who stands by any", right, run.minutes());
  if (o.simulated()) print(innovations_of(std::filesystem::path(o.folder) / "recording.jwr"));
  print("poses against the truth", run.poses());
  if (o.reference.empty()) return;
  const ReferencePoses reference = reference_poses(o.reference, run);
  print("poses against the reference", reference.of_run);
  const StepError step = greatest_step_error(reference.of_run);
  row("from one to the next, off at most", step.translation_m, "m");
  row("the same, heading", step.heading_deg, "deg");
  std::printf("\n");
  print("wheels alone against the reference", reference.of_wheels);
}

}  // namespace
}  // namespace jaywalk::bench

int main(int argc, char** argv) {
  jaywalk::bench::Options o;
  CLI::App app("Scores the tracks and poses in a folder of jaywalk sim or jaywalk replay", "jaywalk_track_bench");
  app.add_option("DIR", o.folder, "the run's folder; a simulation's own movers are the truth")->required();
  app.add_flag("--nobody", o.nobody, "nobody was there: every moving track is false");
  app.add_option("--labels", o.labels,
                 "t_s,id,x_m,y_m in the map, or t_bag,id,x,y in the laser's frame; walks = 0: no matter");
  app.add_option("--between", o.between_s,
                 "s: whoever has labels before and after, so far apart, may be found as well");
  app.add_option("--labels-late", o.late_s, "s: from a scan's stamp to the time that its labels have");
  app.add_option("--laser-mount", o.laser_mount, "X,Y,YAW as given to the replay, for labels in the laser's frame")
      ->delimiter(',')
      ->expected(3);
  app.add_option("--reference", o.reference,
                 "the CARMEN log that was replayed, its poses corrected by others, or a table t,x,y,h");
  app.add_option("--match", o.rules.match_m, "m: a track this near is the target's")->capture_default_str();
  app.add_option("--range", o.view.range_m, "m: simulated movers farther off are not in view")->capture_default_str();
  app.add_option("--radius", o.view.radius_m, "m: of simulated movers")->capture_default_str();
  return jaywalk::bench::run(app, argc, argv, [&o] { jaywalk::bench::score(o); });
}
