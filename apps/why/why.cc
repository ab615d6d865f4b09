#include "apps/why/why.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

#include "apps/report/csv_file.h"
#include "drivers/wired_drive.h"
#include "hal/shown_text.h"

namespace jaywalk {
namespace {

constexpr float kWorthSaying_s = 0.05F;

/// The terms beside the time, in the order of the table's columns.
std::array<std::pair<const char*, float>, 7> terms_of(const motion::Cost& cost) {
  return {{{"getting in somebody's way", cost.conflict},
           {"touching a wall", cost.touch},
           {"being braked", cost.stop_zone},
           {"passing close to walls", cost.clearance},
           {"ground that it cannot see", cost.unseen},
           {"being close to people", cost.nearness},
           {"a rough ride", cost.comfort}}};
}

using Driven = std::array<motion::RobotState, motion::kSteps>;

/// A body's nearest place to the robot's outline, and when it is there.
struct Meeting {
  double gap_m = 1e9, at_s = 0.0;

  void consider(double gap, double at) {
    if (gap < gap_m) *this = {gap, at};
  }
};

/// Looks in all of the mover's futures.
Meeting nearest_on(const Driven& driven, const motion::Futures& futures, std::size_t mover,
                   const Footprint& footprint) {
  Meeting best;
  for (int step = 1; step < motion::kFutureSteps; ++step) {  // a step for two of the robot's
    const motion::RobotState& r = driven[static_cast<std::size_t>(2 * step - 1)];
    const Pose2 pose{static_cast<double>(r.x), static_cast<double>(r.y), static_cast<double>(r.heading)};
    const Transform2 robot_from_map = Transform2(inverse(pose));
    const motion::MoverAt& at = futures.at(step, mover);
    for (int k = 0; k < motion::kFutures; ++k) {
      const Vec2 place{static_cast<double>(at.x[k]), static_cast<double>(at.y[k])};
      best.consider(
          footprint.distance_to(robot_from_map * place) - static_cast<double>(futures.movers()[mover].radius_m),
          step * static_cast<double>(motion::kFutureStepS));
    }
  }
  return best;
}

/// Name of a mover: "body 7" where it is tracked. One that stands may be no track.
std::string name_of(const motion::Futures& futures, std::size_t mover, std::span<const Track> tracks) {
  constexpr double kSame_m = 0.5;
  if (futures.movers()[mover].is_hidden) return "a pedestrian out of sight";
  const motion::MoverAt& now = futures.at(0, mover);
  const Vec2 place{static_cast<double>(now.mid_x), static_cast<double>(now.mid_y)};
  const auto off_m = [&](const Track& track) { return distance(track.position_in_map, place); };
  const auto near = std::ranges::min_element(tracks, {}, off_m);
  return near != tracks.end() && off_m(*near) < kSame_m ? "body " + std::to_string(near->id)
                                                        : std::string("a standing pedestrian");
}

/// The mover that may come nearest.
std::string met_in_words(const Driven& driven, const RelivedRun& run) {
  const motion::Futures& futures = run.loop().motion().rollouts()->futures();
  Meeting met;
  std::size_t who = 0;
  for (std::size_t m = 0; m < futures.movers().size(); ++m) {
    const Meeting nearest = nearest_on(driven, futures, m, run.recorded().setup().model.footprint);
    if (nearest.gap_m < met.gap_m) met = nearest, who = m;
  }
  if (met.gap_m > 1e8) return "";
  const std::string name = name_of(futures, who, run.loop().tracker().tracks());
  return name + (met.gap_m <= 0.0 ? " could run into it" : formatted(" could come within %.1f m", met.gap_m)) +
         formatted(" in %.1f s", met.at_s);
}

std::string in_words(const motion::Cost& cost, const Driven& driven, const RelivedRun& run) {
  std::string words = formatted("%.1f s to the goal", static_cast<double>(cost.time)), more;
  for (const auto& [what, value] : terms_of(cost))
    if (value >= kWorthSaying_s)
      more += (more.empty() ? ", plus " : ", ") + formatted("%.1f s for %s", static_cast<double>(value), what);
  const std::string met = cost.conflict + cost.nearness >= kWorthSaying_s ? met_in_words(driven, run) : "";
  return words + more + (met.empty() ? "" : " (" + met + ")");
}

Vec2 place_of(const motion::RobotState& s) { return {static_cast<double>(s.x), static_cast<double>(s.y)}; }

std::vector<Vec2> way_of(const motion::RobotState& start, const Driven& driven) {
  std::vector<Vec2> way{place_of(start)};
  for (const motion::RobotState& s : driven) way.push_back(place_of(s));
  return way;
}

/// The name of a proposal in why.csv, and its words in a sentence. With a switch the compiler reports a missing one.
std::pair<const char*, const char*> names_of(motion::Proposal proposal) {
  using motion::Proposal;
  switch (proposal) {
    case Proposal::kLast: return {"last", "go on as decided before"};
    case Proposal::kFollow: return {"follow", "follow the way"};
    case Proposal::kWaitThenGo: return {"wait_then_go", "wait and then go"};
    case Proposal::kGoThenStop: return {"go_then_stop", "go and then stop"};
    case Proposal::kArc: return {"arc", "drive an arc"};
    case Proposal::kArcBack: return {"arc_back", "back off in an arc"};
    case Proposal::kArcThenFollow: return {"arc_then_follow", "drive an arc, then follow the way"};
    case Proposal::kBackThenFollow: return {"back_then_follow", "back off, then follow the way"};
    case Proposal::kStick: return {"wish", "drive as the stick asks"};
    case Proposal::kGoStraight: return {"go_straight", "turn and drive straight on"};
    case Proposal::kBrake: return {"brake", "brake as hard as it can"};
  }
  return {"unknown", "do something unknown"};
}

/// "to follow the way, as decided 1.2 s before: 25.8 s to the goal, plus 0.4 s for being close to people (body 7 could
/// come within 0.3 m in 1.8 s)".
std::string chosen_in_words(const RelivedRun& run, const Resolve& resolve) {
  const motion::Decision& decision = run.loop().motion().rollouts()->decision();
  const double since_s = to_seconds(decision.at - resolve.at);
  return std::string("to ") + names_of(resolve.proposal).second +
         (since_s > 0.0 ? formatted(", as decided %.1f s before", since_s) : "") + ": " +
         in_words(decision.cost, decision.driven, run);
}

/// "to wait and then go would have cost 0.3 s more: ...": the cheapest of another kind; empty where there is none.
std::string next_best_in_words(const RelivedRun& run, const Weighed& weighed) {
  const auto next = std::ranges::find_if(weighed.alternatives, [&](const motion::Alternative& a) {
    return a.trajectory.proposal != motion::Proposal::kLast && a.trajectory.proposal != weighed.resolve.proposal;
  });
  if (next == weighed.alternatives.end()) return "";
  const float chosen_s = run.loop().motion().rollouts()->decision().cost.total();
  const double more_s = static_cast<double>(next->cost.total() - chosen_s);
  return std::string("to ") + names_of(next->trajectory.proposal).second +
         (std::fabs(more_s) < kWorthSaying_s ? " is as good: "
          : more_s > 0.0                     ? formatted(" would have cost %.1f s more: ", more_s)
                         : formatted(" is better by %.1f s, too little for a change of mind: ", -more_s)) +
         in_words(next->cost, next->driven, run);
}

/// "stop_zone" as a person says it: "something stands in the way". Every reason of the set, joined by "; ".
std::string in_words(Reason reasons) {
  std::string words;
  for (const ReasonRow& row : kReasons)
    if (has(reasons, row.reason)) words += (words.empty() ? "" : "; ") + std::string(row.says);
  return words;
}

constexpr double kDegPerRad = 180.0 / kPi;
constexpr double kLookAhead_s = 5.0;

std::string side(double rad) {
  const double degrees = std::fabs(rad) * kDegPerRad;
  return degrees < 5.0 ? "straight ahead" : formatted("%.0f degrees to the %s", degrees, rad > 0.0 ? "left" : "right");
}

/// Expects that both go on as they do: a robot on a bend is stepped along it.
Meeting nearest(const Track& track, const Pose2& from, const Twist2& twist, const Footprint& footprint) {
  Meeting best;
  for (double t = 0.0; t <= kLookAhead_s; t += 0.1) {
    const double turned = twist.w_radps * t;
    const Vec2 along = direction(from.heading + 0.5 * turned);
    const Vec2 robot = from.position() + along * (twist.v_mps * t);
    const Transform2 robot_from_map = Transform2(inverse(Pose2{robot.x, robot.y, from.heading + turned}));
    const Vec2 then = track.position_in_map + track.velocity_in_map * t;
    best.consider(footprint.distance_to(robot_from_map * then) - track.radius_m, t);
  }
  return best;
}

std::string doing(const TickRecord& t, const DriveModel& drive) {
  const Pose2& p = t.pose.map_from_robot;
  const double v = 0.5 * drive.wheel_radius_m * (t.wheels.left_radps + t.wheels.right_radps);
  return formatted("At %.2f s the robot is at %.2f, %.2f m, heading %.0f degrees, and drives %.2f m/s.\n",
                   to_seconds(t.now), p.x, p.y, p.heading * kDegPerRad, v);
}

std::string saw(const LaserScan& scan) {
  std::size_t hits = 0, nearest = 0;
  for (std::size_t k = 0; k < scan.beam_count; ++k) {
    if (!scan.is_hit(k)) continue;
    if (hits++ == 0 || scan.range_m[k] < scan.range_m[nearest]) nearest = k;
  }
  std::string words = formatted("%zu of %u beams hit something", hits, scan.beam_count);
  if (hits > 0)
    words += formatted(", the nearest %.2f m off, %s of the laser", static_cast<double>(scan.range_m[nearest]),
                       side(scan.angle_rad(nearest)).c_str());
  return words;
}

std::string saw(const TickRecord& t, std::span<const Track> tracks) {
  const auto moving = std::count_if(tracks.begin(), tracks.end(), [](const Track& track) { return track.moving; });
  std::string words = "It saw: " + saw(t.scan);
  for (const LaserScan& scan : t.other_scans) words += formatted("; by scanner %d ", scan.scanner + 1) + saw(scan);
  return words + formatted("; it followed %zu bodies, %d of them moving.\n", tracks.size(), static_cast<int>(moving));
}

std::string in_words(const Meeting& meeting) {
  if (meeting.at_s == 0.0) return meeting.gap_m > 0.0 ? "comes no nearer" : "is beside the robot already";
  return (meeting.gap_m > 0.0 ? formatted("comes to %.1f m of the robot", meeting.gap_m) : "runs into the robot") +
         formatted(" in %.1f s", meeting.at_s);
}

/// The mover that comes nearest if all go on at these speeds.
std::string expected(const RelivedRun& run) {
  const TickRecord& t = run.last();
  const Pose2& here = t.pose.map_from_robot;
  const Track* first = nullptr;
  Meeting met;
  for (const Track& track : run.loop().tracker().tracks()) {
    if (!track.moving) continue;
    const Meeting own = nearest(track, here, t.verdict.permitted, run.recorded().setup().model.footprint);
    if (first == nullptr || own.gap_m < met.gap_m) first = &track, met = own;
  }
  if (first == nullptr) return "It expected: nobody who walks.\n";
  const Vec2 off = first->position_in_map - here.position();
  return formatted("It expected: body %u, %.1f m off, %s, walks %.2f m/s; as both go now it %s.\n", first->id,
                   norm(off), side(wrap_angle(std::atan2(off.y, off.x) - here.heading)).c_str(),
                   norm(first->velocity_in_map), in_words(met).c_str());
}

std::string wanted(const RelivedRun& run, const Weighed& weighed) {
  const TickRecord& t = run.last();
  std::string words = formatted("It wanted: %.2f m/s and to turn %.2f rad/s", t.wanted.v_mps, t.wanted.w_radps);
  if (!t.input.has_goal) return words + "; it has no goal.\n";
  if (!weighed.alternatives.empty()) words += ", " + chosen_in_words(run, weighed.resolve);
  return words + ".\n";
}

std::string permitted(const TickRecord& t) {
  const Twist2& p = t.verdict.permitted;
  if (t.verdict.reasons == Reason::kNone) return "It was permitted: all of that.\n";
  return formatted("It was permitted: %.2f m/s and %.2f rad/s, because ", p.v_mps, p.w_radps) +
         in_words(t.verdict.reasons) + (t.wheels.fault.is_told() ? "; " + describe(t.wheels.fault) : "") + ".\n";
}

std::string otherwise(const RelivedRun& run, const Weighed& weighed) {
  const TickRecord& t = run.last();
  const double braking_m = t.wanted.v_mps * t.wanted.v_mps / (2.0 * run.recorded().setup().model.limits.brake_mps2);
  if (has(t.verdict.reasons, Reason::kStopZone) && std::isfinite(t.verdict.gap_m))
    return formatted("Otherwise: at %.2f m/s it needs %.2f m to brake, and %.2f m are free.\n",
                     std::fabs(t.wanted.v_mps), braking_m, t.verdict.gap_m);
  const std::string next = t.input.has_goal ? next_best_in_words(run, weighed) : "";
  return "Otherwise: " + (next.empty() ? "nothing else was weighed" : next) + ".\n";
}

}  // namespace

DecisionScene scene_of(const motion::GoalRollouts& motion, const std::vector<motion::Alternative>& alternatives) {
  constexpr int kEvery = 5;  // steps: a second
  const motion::Decision& decision = motion.decision();
  DecisionScene scene;
  std::set<motion::Proposal> told{decision.trajectory.proposal};
  for (const motion::Alternative& a : alternatives) {
    const motion::Proposal kind = a.trajectory.proposal;
    if (!told.insert(kind).second) continue;
    std::string name = names_of(kind).first;
    std::replace(name.begin(), name.end(), '_', ' ');
    scene.ways.push_back({std::move(name), way_of(decision.start, a.driven), a.cost.total() - decision.cost.total()});
  }
  scene.chosen = way_of(decision.start, decision.driven);
  for (std::size_t m = 0; m < motion.futures().movers().size(); ++m) {
    for (int step = 0; step < motion::kFutureSteps; step += kEvery) {
      const motion::MoverAt& at = motion.futures().at(step, m);
      const double share = static_cast<double>(step) / (motion::kFutureSteps - 1);
      for (int k = 0; k < motion::kFutures; ++k)
        scene.futures.push_back({{static_cast<double>(at.x[k]), static_cast<double>(at.y[k])}, share});
    }
  }
  return scene;
}

void write_alternatives(const std::vector<motion::Alternative>& alternatives, const std::string& file) {
  CsvFile table(file,
                "attempt,perturbed,total_s,time_s,conflict_s,touch_s,stop_zone_s,clearance_s,unseen_s,nearness_s,"
                "comfort_s,end_x_m,end_y_m,end_heading_rad,end_v_mps,first_v_mps,first_w_radps");
  const auto number = [&table](float value) { table.number(static_cast<double>(value)); };
  for (const motion::Alternative& a : alternatives) {
    table.text(names_of(a.trajectory.proposal).first).count(a.trajectory.perturbed ? 1 : 0);
    for (const float value : {a.cost.total(), a.cost.time}) number(value);
    for (const auto& term : terms_of(a.cost)) number(term.second);
    const motion::RobotState& end = a.driven.back();
    const motion::Command& first = a.trajectory.commands.front();
    for (const float value : {end.x, end.y, end.heading, end.v, first.v, first.w}) number(value);
    table.end_row();
  }
  (void)table.close();
}

std::string why_words(const RelivedRun& run, const Weighed& weighed) {
  const TickRecord& tick = run.last();
  return doing(tick, run.recorded().setup().model.drive) + saw(tick, run.loop().tracker().tracks()) + expected(run) +
         wanted(run, weighed) + permitted(tick) + otherwise(run, weighed);
}

}  // namespace jaywalk
