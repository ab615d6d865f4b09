#include "apps/report/loop_count.h"

#include <algorithm>

namespace jaywalk {

void LoopCount::add(double t_s, const Pose2& pose, Vec2 goal, double to_go_s) {
  if (begun_) {
    way_m_ += distance(last_.position(), pose.position());
    turned_rad_ += wrap_angle(pose.heading - last_.heading);
  }
  const bool is_new = !begun_ || !(goal == goal_);
  begun_ = true, last_ = pose, goal_ = goal;
  if (is_new || to_go_s < least_to_go_s_ - kGetsOn_s) {
    least_to_go_s_ = to_go_s;
    begin_at(way_m_);
  }
  if (way_m_ - pieces_.back().way_m > kPiece_m) pieces_.push_back({way_m_, turned_rad_, turned_rad_});
  Piece& newest = pieces_.back();
  newest.least_rad = std::min(newest.least_rad, turned_rad_);
  newest.most_rad = std::max(newest.most_rad, turned_rad_);
  while (way_m_ - pieces_.front().way_m > kWithin_m) pieces_.pop_front();
  const auto closes = [&](const Piece& piece) {
    return std::max(turned_rad_ - piece.least_rad, piece.most_rad - turned_rad_) >= 2.0 * kPi;
  };
  if (std::none_of(pieces_.begin(), pieces_.end(), closes)) return;
  loops_at_s_.push_back(t_s);
  begin_at(way_m_);
}

void LoopCount::begin_at(double way_m) { pieces_.assign(1, {way_m, turned_rad_, turned_rad_}); }

}  // namespace jaywalk
