#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "hal/types/geometry.h"
#include "hal/types/robot_model.h"
#include "planner/mapping/evidence_map.h"
#include "planner/mapping/keep_out.h"
#include "planner/tracking/standing_pedestrian.h"
#include "planner/tracking/track.h"

namespace jaywalk {

/// How far the robot's outline is from what stands, in any pose near where the map was drawn. Distances come from the
/// surfaces in the evidence map's cells, finer than the cells themselves: in a door of 0.90 m a body of 0.65 m has
/// 12 cm a side. What was never seen counts as free, and goes_unseen() says so.
///
/// Memory is taken in the constructor. Thread: the loop's.
class BodyMap {
 public:
  explicit BodyMap(const Footprint& footprint);

  /// Draws what stands within kReach_m (each axis) of the robot, pedestrians 5 cm wider than they are taken for; of
  /// `moving` those slower than 0.3 m/s, which have stopped for now or may well.
  /// `unseen_walls`, in the robot's frame, are surfaces. Keep-out zones are like surfaces, unless the robot's axle is
  /// in one: then it may leave. Costs about 100 ns a node near a surface.
  void draw(const EvidenceMap& still, const Pose2& map_from_robot, std::span<const StandingPedestrian> standing = {},
            std::span<const Track> moving = {}, const KeepOut& keep_out = {},
            std::span<const Vec2> unseen_walls = {}) noexcept;

  /// From the outline to the nearest surface (m): 0 when it lies on the outline, kFar_m at most, and that as well
  /// beyond the drawn square. Of a surface more than 5 cm inside minus its depth, corners apart. The outline is sampled
  /// every 10 cm, corners included: a lone point between two samples may be nearer than said, by 1.3 cm at 0.1 m.
  [[nodiscard]] double clearance(const Pose2& map_from_robot) const noexcept {
    return clearance(map_from_robot.position(), direction(map_from_robot.heading));
  }
  /// The same with the heading as a unit vector; anything below `least_m`, if that is where it lies, ends the looking.
  [[nodiscard]] double clearance(Vec2 position_in_map, Vec2 ahead, double least_m = 0.0) const noexcept;
  /// From a point to the nearest surface (m), interpolated between nodes 5 cm apart; kFar_m at most.
  [[nodiscard]] double distance_at(Vec2 p_in_map) const noexcept;
  /// Whether part of the outline, or of that behind the axle, lies where nothing was ever seen, neither free nor
  /// occupied. Where the robot stood when the map was drawn, and 3 cm round that, counts as seen.
  enum class Part { kAll, kBehindAxle };
  [[nodiscard]] bool goes_unseen(Vec2 position_in_map, Vec2 ahead, Part part = Part::kAll) const noexcept;
  /// Whether a point lies in the drawn square.
  [[nodiscard]] bool covers(Vec2 p_in_map) const noexcept;

  [[nodiscard]] Vec2 low() const noexcept { return low_; }
  [[nodiscard]] const Footprint& footprint() const noexcept { return footprint_; }

  static constexpr double kReach_m = 3.2;
  static constexpr double kFar_m = 0.5;

 private:
  static constexpr double kNode_m = 0.05;
  static constexpr std::int32_t kSide = 129;  ///< nodes along an axis: 6.4 m
  static constexpr double kPatch_m = 0.1;
  static constexpr std::int32_t kPatches = 64;  ///< along an axis

  void note_unseen(const EvidenceMap& still) noexcept;
  void stamp(Vec2 surface_in_map) noexcept;
  void stamp_zones(const KeepOut& keep_out) noexcept;
  void stamp_round(Vec2 centre_in_map, double radius_m) noexcept;

  Footprint footprint_;
  std::vector<Vec2> outline_;  ///< in the robot's frame
  std::vector<double> spine_;  ///< along the robot's x axis: middles of circles, inside_m_ about, that fill the outline
  double inside_m_ = 0.0;
  std::vector<float> distance_;
  std::vector<std::uint8_t> unseen_;  ///< patches of kPatch_m in the same square
  Vec2 low_;
  Pose2 robot_from_map_;  ///< when it was drawn
};

}  // namespace jaywalk
