#pragma once
// Detours: stretches on which the robot drove much farther than it got nearer to its goal.
#include <vector>

#include "apps/report/loop_count.h"

namespace jaywalk {

/// Judges each 3 m of way: what is above 1.5 times the fall of the way to go is a detour. Detours side by side are one.
class DetourCount {
 public:
  /// `to_go_m`: time to go by the controller's plan, at full speed; infinite where no way is known.
  void add(double t_s, Vec2 position, Vec2 goal, double to_go_m);
  [[nodiscard]] const std::vector<Episode>& detours() const { return detours_; }
  /// Way above 1.5 times the fall, m, of all of them.
  [[nodiscard]] double detour_m() const { return detour_m_; }

 private:
  static constexpr double kStretch_m = 3.0, kFair = 1.5;
  void judge(double t_s, double to_go_m);

  bool begun_ = false;
  Vec2 last_, goal_;
  double from_s_ = 0.0, way_m_ = 0.0, from_to_go_m_ = 0.0;  ///< of the stretch
  double detour_m_ = 0.0;
  std::vector<Episode> detours_;
};

}  // namespace jaywalk
