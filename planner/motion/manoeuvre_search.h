#pragma once
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "planner/motion/body_map.h"
#include "planner/motion/manoeuvre.h"
#include "planner/motion/way_cost.h"

namespace jaywalk {

/// Where a manoeuvre should lead.
struct ManoeuvreGoal {
  Vec2 position_in_map;
  double heading = 0.0;      ///< wished for there
  bool any_heading = false;  ///< the goal itself: how it stands there does not matter
  double within_m = 0.15;    ///< of the place counts as there
  /// And within this of the heading: infinity where it is no more than a wish. Steps are 3.75 degrees (0.065 rad) wide.
  double within_rad = std::numeric_limits<double>::infinity();
};

/// Finds how the whole body gets from a pose towards a place: best-first over (x, y, heading) in cells of 5 cm and
/// 7.5 degrees, by short arcs forward and backward and turns on the spot, each of them with the outline `margin_m` from
/// everything that stands. A metre forward costs 1, backward kBackward, a turn on the spot a change of gear and what
/// was never seen extra; the way that a circle inside the body has (WayCost) guides it.
///
/// Own design; the idea of searching poses with arcs is Dolgov et al., "Practical search techniques in path planning
/// for autonomous driving" (2008). Memory (16 MB) in the constructor. Thread: the loop's.
class ManoeuvreSearch {
 public:
  explicit ManoeuvreSearch(const Footprint& footprint);

  /// The first manoeuvre found, empty when there is none or the work allowed does not suffice: about 5 ms on a desktop
  /// core. Longer ones than a Manoeuvre holds are cut at its capacity.
  /// A start nearer than `margin_m` to something may be left, but nothing approached any further.
  [[nodiscard]] const Manoeuvre& find(const BodyMap& map, const Pose2& start, const ManoeuvreGoal& goal,
                                      double margin_m) noexcept;

 private:
  struct Node {
    Vec2 position;
    float cost, clearance;
    std::int32_t parent;
    std::int16_t heading;  ///< in kHalfStep from the start's
    std::uint8_t move;
  };
  struct Entry {
    float cost;
    std::int32_t node;
    [[nodiscard]] bool operator<(const Entry& o) const { return cost != o.cost ? cost > o.cost : node > o.node; }
  };

  void begin(const BodyMap& map, const Pose2& start, const ManoeuvreGoal& goal, double margin_m) noexcept;
  [[nodiscard]] float rest(const Node& node) const noexcept;
  [[nodiscard]] double heading_error(const Node& node) const noexcept;
  [[nodiscard]] bool has_arrived(const Node& node) const noexcept;
  [[nodiscard]] std::int32_t state_of(const Node& node) const noexcept;
  [[nodiscard]] bool fits_on_the_way(Node& node) const noexcept;
  [[nodiscard]] double clearance(Vec2 position, std::int32_t heading, double least_m) const noexcept;
  void open(const Node& from, std::int32_t index) noexcept;
  void push(const Node& node) noexcept;
  void draw(std::int32_t last) noexcept;

  WayCost way_;
  std::vector<Node> nodes_;
  std::vector<Entry> open_;
  std::vector<std::uint32_t> closed_;  ///< number of the search that has closed the state
  std::uint32_t search_ = 0;
  const BodyMap* map_ = nullptr;
  Pose2 start_;
  ManoeuvreGoal goal_;
  double margin_m_ = 0.0, at_start_m_ = 0.0;
  std::vector<Vec2> axes_;  ///< unit vectors of all headings
  Manoeuvre found_;
};

}  // namespace jaywalk
