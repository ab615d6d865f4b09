#include "apps/report/drive_metrics.h"

#include <cmath>

namespace jaywalk {
constexpr double kLoop_rad = 340.0 / 180.0 * kPi, kWithin_m = 10.0, kPiece_m = 0.05;

void PathShape::add(Vec2 position) {
  if (!newest_) newest_ = last_mark_ = position;
  double step_m = distance(*newest_, position);
  length_m_ += step_m;
  while (step_m > 0.0 && since_mark_m_ + step_m >= kTurnStepM) {
    const double to_mark_m = kTurnStepM - since_mark_m_;
    newest_ = *newest_ + (position - *newest_) * (to_mark_m / step_m);
    mark(*newest_);
    step_m -= to_mark_m;
    since_mark_m_ = 0.0;
  }
  since_mark_m_ += step_m;
  newest_ = position;
}

void PathShape::mark(Vec2 position) {
  const Vec2 step = position - last_mark_;
  if (last_step_) {
    const double turn_deg = std::fabs(atan2(cross(*last_step_, step), dot(*last_step_, step))) * 180.0 / kPi;
    max_turn_deg_ = std::max(max_turn_deg_, turn_deg);
    ++histogram_[std::min(static_cast<std::size_t>(turn_deg / kTurnBinDeg), kTurnBins - 1)];
  }
  last_step_ = step;
  last_mark_ = position;
}

void Smoothness::add(Time t, double speed_mps) {
  samples_.push_back({t, speed_mps});
  while (samples_.size() > 1 && t - samples_[1].t >= kWindow) samples_.pop_front();
  const Sample& before = samples_.front();
  if (t - before.t < kWindow) return;
  Sample& now = samples_.back();
  const double window_s = to_seconds(t - before.t);
  now.accel_mps2 = (speed_mps - before.speed_mps) / window_s;
  accel_.add(std::fabs(*now.accel_mps2));
  if (before.accel_mps2) jerk_.add(std::fabs(*now.accel_mps2 - *before.accel_mps2) / window_s);
}

double LoopCount::loop_since_s() const {
  for (auto piece = pieces_.rbegin(); piece != pieces_.rend(); ++piece) {
    if (turned_rad_ - piece->least_rad >= kLoop_rad) return piece->least_s;
    if (piece->most_rad - turned_rad_ >= kLoop_rad) return piece->most_s;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

void LoopCount::add(double t_s, const Pose2& pose, Vec2 goal) {
  if (!(goal == goal_)) pieces_.clear();
  if (last_) {
    way_m_ += distance(last_->position(), pose.position());
    turned_rad_ += wrap_angle(pose.heading - last_->heading);
  }
  last_ = pose, goal_ = goal;
  if (pieces_.empty() || way_m_ - pieces_.back().way_m > kPiece_m)
    pieces_.push_back({way_m_, turned_rad_, turned_rad_, t_s, t_s});
  Piece& newest = pieces_.back();
  if (turned_rad_ <= newest.least_rad) newest.least_rad = turned_rad_, newest.least_s = t_s;
  if (turned_rad_ >= newest.most_rad) newest.most_rad = turned_rad_, newest.most_s = t_s;
  while (way_m_ - pieces_.front().way_m > kWithin_m) pieces_.pop_front();
  const double since_s = loop_since_s();
  if (std::isnan(since_s)) return;
  loops_.push_back({since_s, t_s});
  pieces_.clear();
}

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
