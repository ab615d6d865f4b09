#include "apps/report/loop_count.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace jaywalk {
namespace {

constexpr double kLoop_rad = 340.0 / 180.0 * kPi;

}  // namespace

void LoopCount::Window::add(double at, double t_s, double turned_rad) {
  if (pieces_.empty() || at - pieces_.back().at > piece_) pieces_.push_back({at, turned_rad, turned_rad, t_s, t_s});
  Piece& newest = pieces_.back();
  if (turned_rad <= newest.least_rad) newest.least_rad = turned_rad, newest.least_s = t_s;
  if (turned_rad >= newest.most_rad) newest.most_rad = turned_rad, newest.most_s = t_s;
  while (at - pieces_.front().at > span_) pieces_.pop_front();
}

double LoopCount::Window::loop_since_s(double turned_rad) const {
  for (auto piece = pieces_.rbegin(); piece != pieces_.rend(); ++piece) {
    if (turned_rad - piece->least_rad >= kLoop_rad) return piece->least_s;
    if (piece->most_rad - turned_rad >= kLoop_rad) return piece->most_s;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

void LoopCount::add(double t_s, const Pose2& pose, Vec2 goal) {
  if (!begun_ || !(goal == goal_)) by_way_.clear(), by_time_.clear();
  if (begun_) {
    way_m_ += distance(last_.position(), pose.position());
    turned_rad_ += wrap_angle(pose.heading - last_.heading);
  }
  begun_ = true, last_ = pose, goal_ = goal;
  by_way_.add(way_m_, t_s, turned_rad_);
  by_time_.add(t_s, t_s, turned_rad_);
  for (Window* const window : {&by_way_, &by_time_}) {
    const double since_s = window->loop_since_s(turned_rad_);
    if (std::isnan(since_s)) continue;
    loops_.push_back({since_s, t_s});
    by_way_.clear(), by_time_.clear();
    return;
  }
}

}  // namespace jaywalk
