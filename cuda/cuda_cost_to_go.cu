#include <cstring>

#include "cuda/cuda_cost_to_go.h"
#include "cuda/kernels.h"
#include "cuda/settle_tiles.h"
#include "planner/cost_to_go/cell_graph.h"
#include "planner/cost_to_go/pose_guide.h"
#include "planner/cost_to_go/pose_price.h"

namespace jaywalk {
namespace {

/// Costs up to so much more than `there`, or anything below `most` where there is none.
template <class Value>
__device__ std::uint32_t limit_beyond(const Value* there, std::uint32_t beyond, std::uint32_t most) {
  const std::uint32_t cost = there == nullptr ? most : peek(there);
  return cost < most - beyond ? cost + beyond : most;
}

/// Poses and the moves between them.
struct PoseWays {
  using Value = std::uint16_t;
  static constexpr Value kNone = PoseGuide::kNoWay;
  static constexpr int kTile = 8, kLayers = PoseLattice::kHeadings, kReach = PoseLattice::kReach, kThreads = 768;
  std::int32_t cells;  ///< a side
  const PoseMove* moves;
  const std::int32_t* count;
  const std::uint8_t *rate, *unseen;
  const Value* robot;  ///< its cost; null: it is nowhere
  std::uint32_t beyond;
  Value* cost;

  [[nodiscard]] JAYWALK_CELL int side() const { return cells; }
  /// The lattice has a rim that no move leaves.
  [[nodiscard]] __device__ static bool holds(int, int) { return true; }
  [[nodiscard]] __device__ int at(int i, int j, int heading) const {
    const int stride = cells + 2 * kReach;
    return (heading * stride + j + kReach) * stride + i + kReach;
  }
  [[nodiscard]] __device__ std::uint32_t limit() const { return limit_beyond(robot, beyond, kNone - 1U); }

  template <class Near>
  [[nodiscard]] __device__ std::uint32_t least(int i, int j, int heading, std::uint32_t own, std::uint32_t limit,
                                               const Near& near) const {
    const std::uint32_t here = rate[at(i, j, heading)];
    if (here == 0) return own;
    for (int m = 0; m < count[heading]; ++m) {
      const PoseMove move = moves[heading * PoseMoves::kMost + m];
      const int turned = heading + move.turn, to = turned < 0 ? turned + kLayers : turned % kLayers;
      const std::uint32_t there = near(move.di, move.dj, to);
      if (there > limit || there + move.cost >= own) continue;  // no rate is lower than in the open
      const int pose = at(i + move.di, j + move.dj, to);
      if (rate[pose] == 0) continue;
      const std::uint32_t through =
          there + price::cost_of(move, here, rate[pose], unseen == nullptr ? 0U : unseen[pose]);
      own = through < own ? through : own;
    }
    return own;
  }
};

/// Cells and the steps to sixteen neighbours. Of a node's two numbers the first is its cost.
struct CellWays {
  using Value = std::uint32_t;
  static constexpr Value kNone = field::kNoWay;
  static constexpr int kTile = 32, kLayers = 1, kReach = 2, kThreads = 512;
  static constexpr int kRing = field::CellGraph::kRing;
  std::int32_t cells;  ///< a side
  const Value* robot;
  std::uint32_t beyond;
  Value* cost;

  [[nodiscard]] JAYWALK_CELL int side() const { return cells; }
  /// A ring of cells about the grid is not free.
  [[nodiscard]] __device__ static bool holds(int, int) { return true; }
  [[nodiscard]] __device__ int at(int i, int j, int) const {
    return 2 * ((j + kRing) * (cells + 2 * kRing) + i + kRing);
  }
  [[nodiscard]] __device__ std::uint32_t limit() const {
    return limit_beyond(robot, beyond, field::CellGraph::kEverywhere);
  }
  [[nodiscard]] __device__ std::uint32_t rate(int i, int j) const { return cost[at(i, j, 0) + 1]; }

  template <class Near>
  [[nodiscard]] __device__ std::uint32_t least(int i, int j, int, std::uint32_t own, std::uint32_t limit,
                                               const Near& near) const {
    const std::uint32_t here = rate(i, j);
    for (int k = 0; here != 0 && k < field::kCellSteps; ++k) {
      const field::CellStep step = field::cell_step(k);
      const int di = step.di, dj = step.dj;
      const std::uint32_t there = near(di, dj, 0), rate_there = rate(i + di, j + dj);
      if (there > (limit < own ? limit : own) || rate_there == 0) continue;
      const bool passes = rate(i + di / 2, j + dj / 2) != 0 && rate(i + di - di / 2, j + dj - dj / 2) != 0;
      const std::uint32_t through = there + step.cost(here, rate_there);
      own = passes && through < own ? through : own;
    }
    return own;
  }
};

template <class T>
void put_in(CudaDevice& device, const Shared<T>& to, const T* from, std::size_t n) noexcept {
  std::memcpy(to.host, from, n * sizeof(T));
  device.copy_in(to, n);
}

}  // namespace

CudaCostToGo::CudaCostToGo(int device, std::chrono::milliseconds limit, std::int32_t max_side)
    : device_(device, limit),
      nodes_(device_.share<std::uint8_t>(kNodes)),
      radius_(device_.share<std::uint8_t>(kMostPoints)),
      places_(device_.share<std::int32_t>(kLooks * kMostPoints)),
      room_(device_.share<std::uint8_t>(PoseLattice::kPoses)),
      shift_(device_.share<std::int8_t>(PoseLattice::kPoses)),
      pose_rate_(device_.share<std::uint8_t>(PoseLattice::kPoses)),
      unseen_(device_.share<std::uint8_t>(PoseLattice::kPoses)),
      pose_cost_(device_.share<std::uint16_t>(PoseLattice::kPoses)),
      moves_(device_.share<PoseMove>(static_cast<std::size_t>(PoseLattice::kHeadings * PoseMoves::kMost))),
      move_count_(device_.share<std::int32_t>(PoseLattice::kHeadings)),
      cells_(device_.share<std::uint32_t>(2 * field::CellGraph::size_for(max_side))),
      waits_(device_.share<std::int32_t>(static_cast<std::size_t>(field::Grid{max_side / 8}.cells()))) {}

template <class Ways>
bool CudaCostToGo::read_settled(const Ways& ways, const Shared<typename Ways::Value>& cost, std::size_t n) noexcept {
  if (!settle_tiles(device_, ways, waits_)) return false;
  device_.copy_out(cost, n);
  return device_.wait();
}

bool CudaCostToGo::find(const field::PoseLook& look) noexcept {
  constexpr std::int32_t kVisits = PoseLattice::kHeadings * PoseLattice::kSide * PoseLattice::kSide;
  const auto points = static_cast<std::size_t>(look.points);
  if (points > kMostPoints || !begins()) return false;
  put_in(device_, nodes_, look.nodes, kNodes);
  put_in(device_, places_, look.places, kLooks * points);
  put_in(device_, radius_, look.radius, points);
  const field::PoseLook on_device{nodes_.device, places_.device, radius_.device,
                                  look.points,   room_.device,   shift_.device};
  device_.launch(visit<field::PoseLook>, kVisits / kVisitThreads, kVisitThreads, on_device, kVisits, kVisits);
  device_.copy_out(room_, PoseLattice::kPoses), device_.copy_out(shift_, PoseLattice::kPoses);
  if (!device_.wait()) return false;
  std::memcpy(look.room, room_.host, PoseLattice::kPoses);
  std::memcpy(look.shift, shift_.host, PoseLattice::kPoses);
  return true;
}

bool CudaCostToGo::settle(const field::PoseCosts& poses) noexcept {
  constexpr std::size_t kPoses = PoseLattice::kPoses;
  if (!begins()) return false;
  put_in(device_, pose_rate_, poses.rate, kPoses);
  if (poses.unseen != nullptr) put_in(device_, unseen_, poses.unseen, kPoses);
  put_in(device_, pose_cost_, poses.cost, kPoses);
  put_in(device_, moves_, poses.moves.from[0].data(), poses.moves.from.size() * PoseMoves::kMost);
  put_in(device_, move_count_, poses.moves.count.data(), poses.moves.count.size());
  const PoseWays ways{PoseLattice::kSide,
                      moves_.device,
                      move_count_.device,
                      pose_rate_.device,
                      poses.unseen == nullptr ? nullptr : unseen_.device,
                      poses.robot < 0 ? nullptr : pose_cost_.device + poses.robot,
                      poses.beyond,
                      pose_cost_.device};
  if (!read_settled(ways, pose_cost_, kPoses)) return false;
  std::memcpy(poses.cost, pose_cost_.host, kPoses * sizeof *poses.cost);
  return true;
}

bool CudaCostToGo::settle(const field::CellCosts& cells) noexcept {
  static_assert(sizeof(field::CellNode) == 2 * sizeof(std::uint32_t));
  const std::size_t n = 2 * field::CellGraph::size_for(cells.side);
  if (!begins()) return false;
  put_in(device_, cells_, &cells.nodes->cost, n);
  const CellWays ways{cells.side, cells_.device + 2 * cells.robot, cells.beyond, cells_.device};
  if (!read_settled(ways, cells_, n)) return false;
  std::memcpy(cells.nodes, cells_.host, n * sizeof(std::uint32_t));
  return true;
}

}  // namespace jaywalk
