#include "apps/report/moments.h"

#include <algorithm>
#include <cstdio>

#include "hal/shown_text.h"

namespace jaywalk {
namespace {
constexpr double kFor_m = 3.0;  ///< a body farther off is no reason
constexpr double kWalks_mps = 0.2;
constexpr std::size_t kMostLines = 10;

std::string place_of(double t_s, Vec2 where) {
  char text[80];
  std::snprintf(text, sizeof text, "  at %.1f s, %.1f, %.1f m", t_s, where.x, where.y);
  return without_minus_zero(text);
}

}  // namespace

void Moments::add(double from_s, double for_s, Vec2 position_in_map, const std::string& what) {
  moments_.push_back({from_s, for_s, position_in_map, what, kFor_m});
}

void Moments::note(double t_s, unsigned id, Vec2 position, Vec2 velocity) {
  for (Moment& moment : moments_) {
    const double away = distance(position, moment.where);
    if (t_s < moment.from_s || t_s > moment.from_s + moment.for_s || away >= moment.nearest_m) continue;
    moment.nearest_m = away, moment.id = id, moment.speed_mps = norm(velocity);
  }
}

std::string Moments::words(const std::string& title) const {
  std::vector<Moment> longest = moments_;
  std::stable_sort(longest.begin(), longest.end(), [](const Moment& a, const Moment& b) { return a.for_s > b.for_s; });
  longest.resize(std::min(longest.size(), kMostLines));
  std::string text;
  for (const Moment& moment : longest) {
    char line[96];
    std::snprintf(line, sizeof line, ", for %.1f s", moment.for_s);
    text += place_of(moment.from_s, moment.where) + line + (moment.what.empty() ? "" : ": " + moment.what);
    std::snprintf(line, sizeof line, "; body %u was %.1f m from its middle and %s", moment.id, moment.nearest_m,
                  moment.speed_mps > kWalks_mps ? "walked" : "stood");
    text += std::string(moment.id != 0 ? line : "; nobody was near") + "\n";
  }
  if (moments_.size() > kMostLines) text += "  and " + std::to_string(moments_.size() - kMostLines) + " shorter\n";
  return text.empty() ? "" : title + "\n" + text;
}

}  // namespace jaywalk
