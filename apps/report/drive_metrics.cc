#include "apps/report/drive_metrics.h"

#include <algorithm>
#include <cmath>

namespace jaywalk {

void PathShape::add(Vec2 position) {
  if (!begun_) {
    begun_ = true;
    newest_ = last_mark_ = position;
    return;
  }
  double step_m = distance(newest_, position);
  length_m_ += step_m;
  while (step_m > 0.0 && since_mark_m_ + step_m >= kTurnStepM) {
    const double to_mark_m = kTurnStepM - since_mark_m_;
    newest_ = newest_ + (position - newest_) * (to_mark_m / step_m);
    mark(newest_);
    step_m -= to_mark_m;
    since_mark_m_ = 0.0;
  }
  since_mark_m_ += step_m;
  newest_ = position;
}

void PathShape::mark(Vec2 position) {
  const Vec2 step = position - last_mark_;
  if (stepped_) {
    const double turn_deg = std::fabs(atan2(cross(last_step_, step), dot(last_step_, step))) * 180.0 / kPi;
    max_turn_deg_ = std::max(max_turn_deg_, turn_deg);
    ++histogram_[std::min(static_cast<std::size_t>(turn_deg / kTurnBinDeg), kTurnBins - 1)];
  }
  stepped_ = true;
  last_step_ = step;
  last_mark_ = position;
}

void Smoothness::add(Time t, double speed_mps) {
  samples_.push_back({t, speed_mps, 0.0, false});
  while (samples_.size() > 1 && t - samples_[1].t >= kWindow) samples_.pop_front();
  const Sample& before = samples_.front();
  if (t - before.t < kWindow) return;
  Sample& now = samples_.back();
  const double window_s = to_seconds(t - before.t);
  now.accel_mps2 = (speed_mps - before.speed_mps) / window_s;
  now.has_accel = true;
  accel_.add(std::fabs(now.accel_mps2));
  if (before.has_accel) jerk_.add(std::fabs(now.accel_mps2 - before.accel_mps2) / window_s);
}

}  // namespace jaywalk
