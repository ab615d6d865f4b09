#include "apps/report/loop_count.h"

#include <cmath>
#include <limits>

namespace jaywalk {
namespace {

constexpr double kLoop_rad = 340.0 / 180.0 * kPi, kWithin_m = 10.0, kPiece_m = 0.05;

}  // namespace

double LoopCount::loop_since_s() const {
  for (auto piece = pieces_.rbegin(); piece != pieces_.rend(); ++piece) {
    if (turned_rad_ - piece->least_rad >= kLoop_rad) return piece->least_s;
    if (piece->most_rad - turned_rad_ >= kLoop_rad) return piece->most_s;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

void LoopCount::add(double t_s, const Pose2& pose, Vec2 goal) {
  if (!begun_ || !(goal == goal_)) pieces_.clear();
  if (begun_) {
    way_m_ += distance(last_.position(), pose.position());
    turned_rad_ += wrap_angle(pose.heading - last_.heading);
  }
  begun_ = true, last_ = pose, goal_ = goal;
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

}  // namespace jaywalk
