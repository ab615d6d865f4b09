#pragma once
#include <cstdint>
#include <vector>

#include "planner/motion/body_map.h"

namespace jaywalk {

/// How far it is (m) to a target for the circle inside the body, round what stands: what a search for the whole body
/// is guided by. Nodes 0.1 m apart over the body map's square, eight neighbours. Memory in the constructor.
class WayCost {
 public:
  explicit WayCost(double radius_m);
  void settle(const BodyMap& map, Vec2 target_in_map) noexcept;
  /// Of the nearest node; infinity where there is no way, and outside.
  [[nodiscard]] float from(Vec2 p_in_map) const noexcept;

 private:
  struct Entry {
    float cost;
    std::int32_t node;
    [[nodiscard]] bool operator<(const Entry& o) const { return cost != o.cost ? cost > o.cost : node > o.node; }
  };
  static constexpr double kNode_m = 0.1;
  static constexpr std::int32_t kSide = 65;

  [[nodiscard]] std::int32_t node_at(Vec2 p) const noexcept;

  double radius_m_;
  Vec2 low_;
  std::vector<float> cost_;
  std::vector<std::uint8_t> free_;
  std::vector<Entry> open_;
};

}  // namespace jaywalk
