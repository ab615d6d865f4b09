#pragma once
// The way beyond the planning window: a coarse map of all that is known, and how far it is to the goal along it.
#include <cstdint>
#include <memory>
#include <vector>

#include "hal/types/time.h"
#include "planner/cost_to_go/cell_graph.h"
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
  [[nodiscard]] Vec2 middle_of(CellIndex cell) const noexcept;
  [[nodiscard]] KnownCell kind(std::int32_t i, std::int32_t j) const noexcept;
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
  std::vector<std::int32_t> changed_;  ///< nodes whose rate has changed since the last repair
  std::int32_t goal_ = CellGraph::kNone;
};

}  // namespace jaywalk::field
