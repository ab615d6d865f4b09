#pragma once
#include <vector>

#include "hal/types/operator_input.h"
#include "planner/cost_to_go/guide_field.h"
#include "planner/cost_to_go/pose_field.h"
#include "tests/motion/ground.h"

namespace jaywalk::tests {

/// A wheelchair's guides on some ground.
struct Chair {
  explicit Chair(const WalledGround& ground, field::CostSettler* settler = nullptr, std::size_t entries = 1U << 20)
      : ground_(ground),
        places_(kBody.inscribed_radius_m(), kBody.circumscribed_radius_m(), 256, nullptr, settler),
        field_(kBody, settler, entries) {}

  const PoseGuide& from(const Pose2& robot, Vec2 goal, double heading = kAnyHeading) {
    const field::Window window{{-118, -118}, 256, 0.1};
    const bool wants = std::isfinite(heading);
    const PlanRequest request{.map_from_robot = robot,
                              .goal_in_map = goal,
                              .speed_mps = 0.6,
                              .still = &ground_.map(),
                              .standing = standing,
                              .poses = {.is_asked = true,
                                        .speeds = kSpeeds,
                                        .wants_heading = wants,
                                        .heading = wants ? static_cast<float>(heading) : 0.0F}};
    guide = places_.settle(request, window, place_memory_);
    return poses = field_.settle(request, guide, memory);
  }
  [[nodiscard]] float seconds(double x, double y, double heading) const {
    return poses.time_to_go(guide, static_cast<float>(x), static_cast<float>(y), static_cast<float>(heading));
  }
  [[nodiscard]] PoseWay way(const Pose2& from) const {
    PoseWay way;
    poses.way_from(static_cast<float>(from.x), static_cast<float>(from.y), static_cast<float>(from.heading), way);
    return way;
  }

  static inline const Footprint kBody = wheelchair().footprint;
  static constexpr PoseSpeeds kSpeeds{.forward = 0.6F, .back = 0.3F, .turn = 1.0F, .spot = 0.5F};
  Guide guide;
  PoseGuide poses;
  std::vector<StandingPedestrian> standing;
  field::PoseField::Memory memory;

 private:
  const WalledGround& ground_;
  field::TimeToGoField places_;
  field::TimeToGoField::Memory place_memory_{256};
  field::PoseField field_;
};

}  // namespace jaywalk::tests
