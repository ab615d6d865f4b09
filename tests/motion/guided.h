#pragma once
#include <memory>
#include <vector>

#include "planner/cost_to_go/guide_field.h"
#include "tests/motion/ground.h"

namespace jaywalk::test {

/// WalledGround that was seen from (-4, -4) to (6, 6), walls drawn on it, and the guide of a P3-DX-like body there.
class Guided {
 public:
  explicit Guided(std::shared_ptr<const KeepOutField> keep_out = nullptr) : field_(0.210, 0.3685, 256, keep_out) {}

  Guided& wall(Vec2 from, Vec2 to) {
    ground_.wall(from, to);
    return *this;
  }
  void forget(CellIndex cell) { ground_.forget(cell); }
  const Guide& towards(Vec2 robot, Vec2 goal) {
    const field::Window window{{-118, -118}, 256, 0.1};
    guide_ = field_.settle({.map_from_robot = {robot.x, robot.y, 0.0},
                            .goal_in_map = goal,
                            .speed_mps = 0.6,
                            .still = &ground_.map(),
                            .standing = standing,
                            .masked = movers},
                           window, memory_);
    return guide_;
  }
  [[nodiscard]] const Guide& guide() const { return guide_; }
  [[nodiscard]] const EvidenceMap& map() const { return ground_.map(); }

  std::vector<MoverDisc> movers;
  std::vector<StandingPedestrian> standing;

 private:
  tests::WalledGround ground_;
  field::TimeToGoField field_;
  field::TimeToGoField::Memory memory_{256};
  Guide guide_;
};

}  // namespace jaywalk::test
