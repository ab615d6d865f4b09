#pragma once
#include <span>

#include "firmware/safety/unseen_walls.h"
#include "hal/types/fixed_vector.h"
#include "hal/types/robot_model.h"
#include "planner/mapping/evidence_map.h"

namespace jaywalk {

/// The walls near the robot as its map has them, for the supervisor: what stands where the laser does not look now.
/// Of what has not stood for a second nothing is said: a walker leaves such behind. Thread: the loop's.
class KnownWalls final : public KnownGround {
 public:
  explicit KnownWalls(const Footprint& footprint) : reach_m_(footprint.circumscribed_radius_m() + kBeyond_m) {}

  /// Points in the robot's frame, at most 3 cm apart along a wall; valid until the next call.
  [[nodiscard]] std::span<const Vec2> near(const EvidenceMap& still, const Pose2& map_from_robot) noexcept;

  /// Both as of that call's map and pose.
  [[nodiscard]] bool seen_free(Vec2 place) const noexcept override {
    return still_ != nullptr && still_->seen_free(still_->cell_at(map_from_robot_ * place));
  }
  void suppose(Vec2 place) noexcept override;

 private:
  static constexpr double kBeyond_m = 0.4;  ///< what stopping takes from 0.3 m/s, and the stop zone's margin

  double reach_m_;
  const EvidenceMap* still_ = nullptr;
  Pose2 map_from_robot_;
  FixedVector<Vec2, 2048> points_;
  FixedVector<Vec2, 256> supposed_;  ///< in the map
};

}  // namespace jaywalk
