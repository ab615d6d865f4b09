#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "hal/types/time.h"
#include "planner/cost_to_go/cell_graph.h"
#include "planner/cost_to_go/cost_settler.h"
#include "planner/cost_to_go/guide.h"
#include "planner/cost_to_go/nearest_surfaces.h"
#include "planner/cost_to_go/planner.h"
#include "planner/cost_to_go/shortest.h"
#include "planner/mapping/known_map.h"

namespace jaywalk::field {

/// Cells of kFine x kFine of the evidence map's (0.4 m), each a wall where any of those is: openings of twice that are
/// always found. It begins with the known map, takes over what the evidence map knows, and remembers what has left it.
/// A square of 512 cells (205 m), or as many as hold the known map, 500 m a side at most; where robot and goal do not
/// fit, it is laid anew about them. Costs are the fixed point on a CellGraph, and repaired where few cells changed.
///
/// Memory in the constructor: 34 bytes a cell, 9 to 53 MB. Thread: the planner's.
class FarGuide {
 public:
  FarGuide(double cell_m, std::shared_ptr<const KnownMap> known);

  /// Once a second, and for another goal: what `still` knows (null: nothing), and the way to the goal. A goal beyond
  /// the square counts as at its border.
  void settle(Time now, const EvidenceMap* still, Vec2 robot_in_map, Vec2 goal_in_map) noexcept;

  /// Along free ground, m: dearer near walls and where nothing was ever seen. Infinity in a cell with a wall in it,
  /// outside and where no way is known.
  [[nodiscard]] double to_go_m(Vec2 p_in_map) const noexcept;
  /// Whether a way leads from here, or from a cell beside it.
  [[nodiscard]] bool has_way_near(Vec2 p_in_map) const noexcept;

 private:
  static constexpr std::int32_t kFine = 4;

  [[nodiscard]] CellIndex cell_at(Vec2 p_in_map) const noexcept;
  [[nodiscard]] Vec2 middle_of(CellIndex cell) const noexcept {
    return {(cell.i + low_.i + 0.5) * cell_m_, (cell.j + low_.j + 0.5) * cell_m_};
  }
  [[nodiscard]] KnownCell kind(std::int32_t i, std::int32_t j) const noexcept {
    return grid_.holds(i, j) ? kinds_[static_cast<std::size_t>(grid_.at(i, j))] : KnownCell::kUnknown;
  }
  [[nodiscard]] std::uint32_t rate(std::int32_t i, std::int32_t j) const noexcept;
  void lay_about(Vec2 middle_in_map) noexcept;
  void note(CellIndex fine, KnownCell as) noexcept;
  void take_over(const EvidenceMap& still) noexcept;
  void set(CellIndex cell, KnownCell as) noexcept;
  [[nodiscard]] std::int32_t goal_node(Vec2 goal_in_map) const noexcept;
  void settle_anew() noexcept;

  double cell_m_;  ///< of its own cells
  std::shared_ptr<const KnownMap> known_;
  Grid grid_;
  CellIndex low_;
  bool laid_ = false, settled_ = false;
  Time updated_ = kNever;
  std::vector<KnownCell> kinds_;
  CellGraph graph_;
  Shortest repair_;
  std::vector<std::int32_t> changed_;  ///< nodes with another rate than at the last repair
  std::int32_t goal_ = CellGraph::kNone;
};

/// Nearest surfaces and the time to go to the goal, for a body of which `inscribed_m` is the narrowest half: nearer to
/// a surface than that it cannot be, nearer than its corners reach is dear, and room of up to a metre is worth a
/// detour. Keep-out zones are like surfaces to it, but for a robot in one: that may leave, and what lies in zones is
/// dear then. Costs are integers, so that the shortest way is the same whatever the order of the work: the fixed point
/// of cost[n] = min(cost[c] + step) over sixteen neighbours. Where few cells have changed since the last time, what
/// depends on them is repaired, to the same bytes.
///
/// What is settled anew `settler` is asked for first; where it fails, and without one, it is settled here. `far`:
/// settled before, for a goal outside the window; without it the way goes straight on there.
/// Memory for windows of up to `max_side` cells in the constructor. Thread: the planner's.
class TimeToGoField {
 public:
  /// The arrays that a result needs; take one a result, for one TimeToGoField.
  struct Memory {
    std::uint64_t round = 0;  ///< in which it was filled last
    std::vector<Place> surface;
    std::vector<std::uint8_t> unseen;
    std::vector<float> to_go_s;
    explicit Memory(std::int32_t max_side);
  };

  TimeToGoField(double inscribed_m, double circumscribed_m, std::int32_t max_side,
                std::shared_ptr<const KeepOutField> keep_out = nullptr, CostSettler* settler = nullptr,
                const FarGuide* far = nullptr);

  /// Fills `memory` and returns a view of it.
  Guide settle(const PlanRequest& request, const Window& window, Memory& memory) noexcept;

  /// What it was settled on, until the next time.
  [[nodiscard]] const CellGraph& graph() const noexcept { return graph_; }
  /// Whether the costs are the fixed point: where there is none, there is no way.
  [[nodiscard]] bool is_certified() const noexcept { return certified_; }
  /// For pictures: seconds by cell, NaN where the body's middle cannot be, infinity where no way leads on.
  void draw(const Guide& guide, float* seconds) const noexcept;

 private:
  [[nodiscard]] CellBox box_of(const PlanRequest& request) noexcept;
  void weigh(const PlanRequest& request, bool same_ground, const std::uint8_t* unseen) noexcept;
  void weigh_ground(std::int32_t j) noexcept;
  void add_weight(std::int32_t c, float weight) noexcept;
  void settle_costs(const PlanRequest& request, bool same_ground) noexcept;
  [[nodiscard]] bool repair_costs(Grid grid, std::int32_t robot) noexcept;
  void settle_anew(const PlanRequest& request, std::int32_t robot) noexcept;
  [[nodiscard]] std::int32_t goal_cell(const PlanRequest& request) const noexcept;
  void seed_border(const PlanRequest& request) noexcept;
  void write(const PlanRequest& request, Memory& memory) noexcept;
  [[nodiscard]] bool leads_through_unseen(const PlanRequest& request, const std::uint8_t* unseen) const noexcept;
  [[nodiscard]] std::uint16_t rate_at(float distance_m) const noexcept;

  float blocked_m_, tight_m_, tight_weight_;
  std::shared_ptr<const KeepOutField> keep_out_field_;
  KeepOut keep_out_;
  bool leaves_zone_ = false;  ///< the robot is in one
  NearestSurfaces surfaces_;
  Window window_;  ///< of the request, and what of it the work is limited to
  CellBox box_;
  std::uint64_t round_ = 0;
  std::vector<std::uint64_t> row_round_;         ///< in which a row's surfaces changed last
  std::vector<std::uint16_t> ground_rate_;       ///< by surfaces and keep-out zones alone; 0: not free
  std::vector<std::uint16_t> rate_, last_rate_;  ///< with all that is added
  std::vector<std::int32_t> changed_;            ///< cells whose rate is not that of the last time
  std::vector<float> middle_x_m_;                ///< of a row's cells, in the map
  std::vector<std::int8_t> evidence_;            ///< of a row
  std::int32_t goal_ = CellGraph::kNone;         ///< cell that ways lead to; kNone: none, or many
  bool certified_ = false;
  CellGraph graph_;
  Shortest repair_;
  CostSettler* settler_;
  const FarGuide* far_;
};

}  // namespace jaywalk::field
