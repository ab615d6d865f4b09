#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "planner/field/nearest_surfaces.h"
#include "planner/guide.h"
#include "planner/planner.h"

namespace jaywalk::field {

/// What the way to the goal is sought among.
struct GuideRequest {
  Window window;
  const EvidenceMap* still = nullptr;
  std::span<const MoverDisc> movers;
  Vec2 robot_in_map, goal_in_map;
  double speed_mps = 0.0;
};

/// Nearest surfaces and the time to the goal, for a body of which `inscribed_m` is the narrowest half: nearer to a
/// surface than that is no way, nearer than its corners reach is dear, and room of up to a metre is worth a detour.
/// Costs are integers, so that the shortest way is the same whatever the order of the work: the fixed point of
/// cost[n] = min(cost[c] + step) over sixteen neighbours.
///
/// Memory for windows of up to `max_side` cells in the constructor. Thread: the planner's.
class GuideField {
 public:
  /// The arrays that a result needs; take one a result.
  struct Memory {
    std::vector<Place> surface;
    std::vector<std::uint8_t> unseen;
    std::vector<float> to_go_s;
    explicit Memory(std::int32_t max_side);
  };

  GuideField(double inscribed_m, double circumscribed_m, std::int32_t max_side);

  /// Fills `memory` and returns the look at it.
  Guide settle(const GuideRequest& request, Memory& memory) noexcept;

 private:
  struct Entry {
    std::int32_t cell, next;
  };

  [[nodiscard]] CellBox box_of(const GuideRequest& request) const noexcept;
  void weigh(const GuideRequest& request, const CellBox& box, const Memory& memory) noexcept;
  [[nodiscard]] bool leads_through_unseen(const GuideRequest& request, const CellBox& box,
                                          const Memory& memory) const noexcept;
  void settle_costs(const GuideRequest& request, const CellBox& box) noexcept;
  void seed(const GuideRequest& request, const CellBox& box) noexcept;
  void relax_from(std::int32_t c, const CellBox& box, std::int32_t side) noexcept;
  void push(std::int32_t c, std::uint32_t cost) noexcept;
  [[nodiscard]] std::uint16_t rate_at(float distance_m) const noexcept;

  float blocked_m_, tight_m_;
  NearestSurfaces surfaces_;
  std::vector<std::uint16_t> rate_;  ///< 0: no way
  std::vector<std::uint32_t> cost_;
  std::vector<Entry> entries_;
  std::vector<std::int32_t> heads_;
  std::int32_t spare_ = -1;
  std::size_t used_ = 0, queued_ = 0;
};

}  // namespace jaywalk::field
