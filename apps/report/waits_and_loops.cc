#include "apps/report/waits_and_loops.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "hal/shown_text.h"

namespace jaywalk {
namespace {

constexpr double kLeastWait_s = 3.0;
constexpr double kFor_m = 3.0;  ///< a body farther off is no reason to wait
constexpr double kWalks_mps = 0.2;
constexpr double kLoopWay_m = 6.0;
constexpr double kStep_m = 0.01, kStep_rad = 0.02;  ///< smaller motions are gathered
constexpr std::size_t kMostLines = 10;

std::string place_of(double t_s, Vec2 where) {
  char text[80];
  std::snprintf(text, sizeof text, "  at %.1f s, %.1f, %.1f m", t_s, where.x, where.y);
  return without_minus_zero(text);
}

}  // namespace

void Waits::add(double from_s, double for_s, const Pose2& map_from_robot, const std::string& cause) {
  if (for_s >= kLeastWait_s) waits_.push_back({from_s, for_s, map_from_robot.position(), cause, kFor_m});
}

void Waits::note(double t_s, unsigned id, Vec2 position, Vec2 velocity) {
  for (Wait& wait : waits_) {
    const double away = distance(position, wait.where);
    if (t_s < wait.from_s || t_s > wait.from_s + wait.for_s || away >= wait.nearest_m) continue;
    wait.nearest_m = away, wait.id = id, wait.speed_mps = norm(velocity);
  }
}

std::string Waits::words() const {
  std::vector<Wait> longest = waits_;
  std::stable_sort(longest.begin(), longest.end(), [](const Wait& a, const Wait& b) { return a.for_s > b.for_s; });
  longest.resize(std::min(longest.size(), kMostLines));
  std::string text;
  for (const Wait& wait : longest) {
    char line[96];
    std::snprintf(line, sizeof line, ", for %.1f s: ", wait.for_s);
    text += place_of(wait.from_s, wait.where) + line + wait.cause;
    std::snprintf(line, sizeof line, "; body %u was %.1f m from its middle and %s", wait.id, wait.nearest_m,
                  wait.speed_mps > kWalks_mps ? "walked" : "stood");
    text += std::string(wait.id != 0 ? line : "; nobody was near") + "\n";
  }
  return text.empty() ? "" : "Its longest waits:\n" + text;
}

void Loops::add(double t_s, const Pose2& pose) {
  if (!finite(pose)) return;
  if (!std::exchange(begun_, true)) before_ = pose, passed_ = {{0.0, 0.0}};
  Passed now = passed_.back();
  const double way_m = distance(pose.position(), before_.position());
  const double turned_rad = wrap_angle(pose.heading - before_.heading);
  if (way_m < kStep_m && std::fabs(turned_rad) < kStep_rad) return;
  now.way_m += way_m, now.turned_rad += turned_rad;
  before_ = pose;
  passed_.push_back(now);
  while (now.way_m - passed_.front().way_m > kLoopWay_m) passed_.pop_front();
  const auto is_turn_from = [&](const Passed& then) {
    return std::fabs(now.turned_rad - then.turned_rad) >= 2.0 * kPi;
  };
  if (std::none_of(passed_.begin(), passed_.end(), is_turn_from)) return;
  loops_.push_back({t_s, pose.position()});
  passed_ = {now};
}

std::string Loops::words() const {
  std::string text;
  for (std::size_t k = 0; k < std::min(loops_.size(), kMostLines); ++k)
    text += place_of(loops_[k].at_s, loops_[k].where) + ": a full turn within 6 m of way\n";
  return text.empty() ? "" : "Loops, " + std::to_string(loops_.size()) + " in all:\n" + text;
}

}  // namespace jaywalk
