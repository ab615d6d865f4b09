#include "apps/report/waits.h"

#include <algorithm>
#include <cstdio>

#include "hal/shown_text.h"

namespace jaywalk {
namespace {

constexpr double kLeastWait_s = 3.0;
constexpr double kFor_m = 3.0;  ///< a body farther off is no reason to wait
constexpr double kWalks_mps = 0.2;
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

}  // namespace jaywalk
