#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "apps/jaywalk/commands.h"
#include "apps/jaywalk/progress.h"
#include "apps/report/picture/scene.h"
#include "apps/why/recorded_run.h"
#include "apps/why/why.h"
#include "hal/shown_text.h"
#include "hal/types/errors.h"

namespace jaywalk {
namespace {

constexpr double kShown_m = 8.0;  // to each side of the robot

/// How robot and bodies went until the moment.
struct Past {
  DrivenWay driven;
  TrailBook bodies;
  Resolve resolve;

  void add(const RelivedRun& run) {
    const TickRecord& t = run.last();
    driven.add(t.now, t.pose.map_from_robot);
    if (const motion::GoalRollouts* motion = run.loop().motion().rollouts()) note(motion->decision());
    for (const Track& track : run.loop().tracker().tracks())
      bodies.add(track.id, t.now, track.position_in_map, track.radius_m, track.moving);
  }
  void note(const motion::Decision& decision) {
    const motion::Proposal proposal = decision.trajectory.proposal;
    if (proposal != motion::Proposal::kLast && decision.at != resolve.at) resolve = {proposal, decision.at};
  }
  /// Of the tracks followed now.
  [[nodiscard]] std::vector<Trail> trails(const RelivedRun& run) const {
    std::vector<Trail> known = bodies.trails();
    const auto tracks = run.loop().tracker().tracks();
    std::erase_if(known, [&](const Trail& trail) { return std::ranges::count(tracks, trail.id, &Track::id) == 0; });
    return known;
  }
};

/// Lives through it up to that time.
Past relive(RelivedRun& run, double until_s) {
  Past past;
  Progress progress;
  bool any = run.step();
  const Time first = run.last().now;
  for (; any && to_seconds(run.last().now) < until_s - 1e-6; any = run.step()) {
    past.add(run);
    const Time now = run.last().now;
    progress.show(to_seconds(now - first) / (until_s - to_seconds(first)),
                  formatted("%.0f of %.0f s", to_seconds(now), until_s));
  }
  if (any && until_s < to_seconds(first) - 1e-6)
    while (run.step()) any = false;
  if (!any)
    throw StartupError(run.recorded().file().string() + ": has nothing of that time",
                       formatted("give a time from %.2f to %.2f s", to_seconds(first), to_seconds(run.last().now)));
  past.add(run);
  return past;
}

/// The last decision and the time to go that it rests on, in the place of the path.
void show_decision(const RelivedRun& run, const Weighed& weighed, PictureScene& scene) {
  if (weighed.alternatives.empty() || !run.loop().plan().guide.known()) return;
  scene.decision = scene_of(*run.loop().motion().rollouts(), weighed.alternatives);
  if (!scene.moment) scene.moment = PlanMoment{run.last().now, run.last().pose.map_from_robot, {}, {}, {}, {}};
  scene.moment->band.clear();
  scene.moment->field = raster_of(run.planner().view_field());
}

PictureScene scene_of(const RelivedRun& run, const Past& past, const Weighed& weighed) {
  const TickRecord& t = run.last();
  const ControlLoop& loop = run.loop();
  BusiestMoment moment;
  moment.consider(loop.plan(), run.planner(), loop.tracker().tracks(), t.pose.map_from_robot);
  PictureScene scene;
  scene.title = formatted("why, at %.2f s", to_seconds(t.now));
  const std::string reasons = to_string(t.verdict.reasons, t.verdict.faulty_scanners);
  scene.facts = {{"reasons", reasons.empty() ? "none" : reasons}};
  scene.driven = past.driven.poses();
  scene.tracks = past.trails(run);
  scene.occupied = occupied_cells(loop.tracker().still(), scene.driven, kShown_m);
  scene.cell_m = loop.tracker().still().cell_m();
  scene.moment = moment.moment();
  show_decision(run, weighed, scene);
  if (t.input.has_goal) scene.goal = t.input.goal_in_map;
  scene.footprint = run.recorded().setup().model.footprint;
  const Vec2 here = t.pose.map_from_robot.position(), reach{kShown_m, kShown_m};
  scene.extent = {here - reach, here + reach};
  return scene;
}

Weighed weighed_by(const RelivedRun& run, const Past& past) {
  const motion::GoalRollouts* motion = run.loop().motion().rollouts();
  if (motion == nullptr || motion->decision().at == kNever) return {};
  return {past.resolve, motion->alternatives(run.loop().plan())};
}

/// Returns the picture, or nothing where none can be drawn.
std::optional<std::filesystem::path> save(const PictureScene& scene, const std::filesystem::path& folder) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed) throw StartupError(folder.string() + ": cannot be made: " + failed.message(), "choose another --out");
  if (!can_draw_pictures()) return std::nullopt;
  draw_picture(scene, (folder / "why.png").string());
  return folder / "why.png";
}

/// `folder`: a run's, or a recording.jwr; `out`: where the picture goes.
int run_why(const std::filesystem::path& folder, double at_s, const std::filesystem::path& out) {
  RecordedRun recorded(folder);
  RelivedRun run(recorded);
  if (!std::isfinite(at_s)) throw StartupError("T_S: no time", "give seconds");
  const Past past = relive(run, at_s);
  const Weighed weighed = weighed_by(run, past);
  const std::optional<std::filesystem::path> drawn = save(scene_of(run, past, weighed), out);
  if (!weighed.alternatives.empty()) write_alternatives(weighed.alternatives, (out / "why.csv").string());
  std::fputs(why_words(run, weighed).c_str(), stdout);
  std::fputs(run.remarks().c_str(), stderr);
  if (drawn) std::printf("See %s\n", drawn->c_str());
  return 0;
}

}  // namespace

void add_why(CLI::App& app, int& exit_code) {
  static std::filesystem::path run, out = "out/why";
  static double at_s = 0.0;
  CLI::App* why = app.add_subcommand("why", "One moment of a recording: what it saw, wanted, was permitted, and why");
  why->add_option("run", run, "A run's folder, or its recording.jwr")->required();
  why->add_option("t_s", at_s, "When, in seconds of the recording's clock")->required();
  why->add_option("--out", out, "Folder for why.png")->capture_default_str();
  why->callback([&exit_code] { exit_code = run_why(run, at_s, out); });
}

}  // namespace jaywalk
