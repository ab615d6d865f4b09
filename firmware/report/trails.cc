#include "firmware/report/trails.h"

namespace jaywalk {

void TrailBook::add(std::uint32_t id, Time t, Vec2 position, double radius_m, bool flag) {
  Trail& trail = trails_[id];
  trail.id = id;
  trail.radius_m = radius_m;
  trail.flagged = trail.flagged || flag;
  if (trail.points.empty() || t - trail.points.back().t >= kSpacing) trail.points.push_back({t, position});
}

std::vector<Trail> TrailBook::trails() const {
  std::vector<Trail> all;
  all.reserve(trails_.size());
  for (const auto& [id, trail] : trails_) all.push_back(trail);
  return all;
}

}  // namespace jaywalk
