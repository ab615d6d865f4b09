#include "apps/report/detour_count.h"

#include <algorithm>
#include <cmath>

namespace jaywalk {

void DetourCount::add(double t_s, Vec2 position, Vec2 goal, double to_go_m) {
  const bool counts = begun_ && goal == goal_ && std::isfinite(to_go_m);
  if (counts) way_m_ += distance(last_, position);
  last_ = position, goal_ = goal, begun_ = std::isfinite(to_go_m);
  if (counts && way_m_ < kStretch_m) return;
  if (counts) judge(t_s, to_go_m);
  from_s_ = t_s, way_m_ = 0.0, from_to_go_m_ = to_go_m;
}

void DetourCount::judge(double t_s, double to_go_m) {
  const double over_m = way_m_ - kFair * std::max(from_to_go_m_ - to_go_m, 0.0);
  if (over_m <= 0.0) return;
  detour_m_ += over_m;
  if (!detours_.empty() && detours_.back().to_s == from_s_)
    detours_.back().to_s = t_s;
  else
    detours_.push_back({from_s_, t_s});
}

}  // namespace jaywalk
