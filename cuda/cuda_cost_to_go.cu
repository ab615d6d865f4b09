#include <cstring>
#include <type_traits>

#include "cuda/cuda_cost_to_go.h"
#include "cuda/kernels.h"
#include "planner/cost_to_go/cell_graph.h"
#include "planner/cost_to_go/pose_guide.h"
#include "planner/cost_to_go/pose_price.h"

namespace jaywalk {
namespace {

/// Costs of all nodes, and where ways end: beyond that of a node, negative: nowhere.
template <class Steps>
struct Ends {
  static constexpr std::uint32_t kNone = Steps::kNone, kSpan = Steps::kSpan;
  LoweredCosts costs;
  std::int32_t robot;
  std::uint32_t beyond;

  [[nodiscard]] __device__ std::uint32_t limit() const {
    return Steps::end(robot < 0 ? kNone : costs.peek(robot), beyond);
  }
};

/// Poses and the moves between them.
struct Poses : Ends<field::PoseSteps> {
  static constexpr int kThreads = 16;
  field::PoseSteps steps;

  [[nodiscard]] __device__ std::int32_t count(std::int32_t pose) const { return steps.count(pose); }
  template <class May, class Visit>
  __device__ void step(std::int32_t pose, std::int32_t k, const May& may, const Visit& visit) const {
    steps.step(pose, k, may, visit);
  }
};

/// Cells and the steps to sixteen neighbours.
struct Cells : Ends<field::CellSteps> {
  static constexpr int kThreads = 16;
  field::CellSteps steps;

  [[nodiscard]] __device__ static std::int32_t count(std::int32_t) { return field::kCellSteps; }
  template <class May, class Visit>
  __device__ void step(std::int32_t cell, std::int32_t k, const May& may, const Visit& visit) const {
    steps.step(cell, field::cell_step(k), may, visit);
  }
};

/// A pose's rate. A given cost is widened, as atomic operations want it, and put on the pile.
struct SowPose {
  field::PoseRates rates;
  const std::uint16_t* given;
  std::uint32_t* cost;
  Piles piles;

  __device__ void operator()(std::int32_t pose) const {
    rates(pose);
    const std::uint32_t sown = rates.rate[pose] != 0 ? given[pose] : PoseGuide::kNoWay;
    cost[pose] = sown;
    if (sown != PoseGuide::kNoWay) piles.sow(pose, sown);
  }
};
struct ReapPose {
  const std::uint32_t* cost;
  std::uint16_t* settled;

  __device__ void operator()(std::int32_t pose) const { settled[pose] = static_cast<std::uint16_t>(cost[pose]); }
};
struct SowCell {
  const field::CellNode* nodes;
  Piles piles;

  __device__ void operator()(std::int32_t cell) const {
    if (nodes[cell].cost != field::kNoWay) piles.sow(cell, nodes[cell].cost);
  }
};

template <class Stage>
void launch_visits(CudaDevice& device, const Stage& stage, std::int32_t n) noexcept {
  device.launch(visit<Stage>, (n + kVisitThreads - 1) / kVisitThreads, kVisitThreads, stage, 1, n);
}

constexpr std::size_t kPoses = PoseLattice::kPoses, kRooms = 256;

template <class T>
void copy_in(CudaDevice& device, const Shared<T>& to, const T* from, std::size_t n) noexcept {
  std::memcpy(to.host, from, n * sizeof(T));
  device.copy_in(to, n);
}

}  // namespace

CudaCostToGo::CudaCostToGo(int device, std::chrono::milliseconds limit, std::int32_t max_side)
    : device_(device, limit),
      nodes_(device_.share<std::uint8_t>(kNodes)),
      radius_(device_.share<std::uint8_t>(kMostPoints)),
      rate_of_room_(device_.share<std::uint8_t>(kRooms)),
      places_(device_.share<std::int32_t>(kLooks * kMostPoints)),
      room_(device_.share<std::uint8_t>(PoseLattice::kPoses)),
      shift_(device_.share<std::int8_t>(PoseLattice::kPoses)),
      pose_rate_(device_.share<std::uint8_t>(PoseLattice::kPoses)),
      dearer_(device_.share<std::uint8_t>(PoseLattice::kPoses)),
      unseen_(device_.share<std::uint8_t>(PoseLattice::kPoses)),
      pose_cost_(device_.share<std::uint16_t>(PoseLattice::kPoses)),
      wide_cost_(device_.take<std::uint32_t>(PoseLattice::kPoses)),
      moves_(device_.share<field::BackMoves>(1)),
      cells_(device_.share<field::CellNode>(field::CellGraph::size_for(max_side))),
      told_(device_.share<Piles::Told>(1)) {
  for (Piles::Entry*& pile : piles_.pile) pile = device_.take<Piles::Entry>(Piles::kRoom);
  piles_.told = told_.device;
}

template <class Graph, class T>
bool CudaCostToGo::read_settled(const Graph& graph, const Shared<T>& settled, std::size_t n) noexcept {
  device_.launch(settle_piles<Graph>, 1, kPileThreads, graph, piles_);
  if constexpr (std::is_same_v<Graph, Poses>)
    launch_visits(device_, ReapPose{wide_cost_, settled.device}, PoseLattice::kPoses);
  device_.copy_out(settled, n);
  device_.copy_out(told_, 1);
  return device_.wait() && told_.host->full == 0;
}

void CudaCostToGo::put_in(const field::PoseCosts& poses) noexcept {
  const auto points = static_cast<std::size_t>(poses.look.points);
  copy_in(device_, nodes_, poses.look.nodes, kNodes);
  copy_in(device_, places_, poses.look.places, kLooks * points);
  copy_in(device_, radius_, poses.look.radius, points);
  copy_in(device_, rate_of_room_, poses.rates.of_room, kRooms);
  if (poses.rates.dearer != nullptr) copy_in(device_, dearer_, poses.rates.dearer, kPoses);
  if (poses.steps.unseen != nullptr) copy_in(device_, unseen_, poses.steps.unseen, kPoses);
  copy_in(device_, pose_cost_, poses.cost, kPoses);
  copy_in(device_, moves_, poses.steps.moves, 1);
  device_.set_bytes(told_.device, 0, 1);
}

bool CudaCostToGo::settle(const field::PoseCosts& poses) noexcept {
  constexpr std::int32_t kCellPoses = PoseLattice::kHeadings * PoseLattice::kSide * PoseLattice::kSide;
  if (static_cast<std::size_t>(poses.look.points) > kMostPoints || !begins()) return false;
  put_in(poses);
  const field::PoseLook look{nodes_.device,     places_.device, radius_.device,
                             poses.look.points, room_.device,   shift_.device};
  const field::PoseRates rates{rate_of_room_.device, poses.rates.dearest,
                               room_.device,         poses.rates.dearer == nullptr ? nullptr : dearer_.device,
                               poses.robot,          pose_rate_.device};
  launch_visits(device_, look, kCellPoses);
  launch_visits(device_, SowPose{rates, pose_cost_.device, wide_cost_, piles_}, PoseLattice::kPoses);
  device_.copy_out(room_, kPoses), device_.copy_out(shift_, kPoses), device_.copy_out(pose_rate_, kPoses);
  const Poses graph{{{wide_cost_, 1}, poses.robot, poses.beyond},
                    {moves_.device, pose_rate_.device, poses.steps.unseen == nullptr ? nullptr : unseen_.device}};
  if (!read_settled(graph, pose_cost_, kPoses)) return false;
  std::memcpy(poses.look.room, room_.host, kPoses);
  std::memcpy(poses.look.shift, shift_.host, kPoses);
  std::memcpy(poses.rates.rate, pose_rate_.host, kPoses);
  std::memcpy(poses.cost, pose_cost_.host, kPoses * sizeof *poses.cost);
  return true;
}

bool CudaCostToGo::settle(const field::CellCosts& cells) noexcept {
  const std::size_t n = field::CellGraph::size_for(cells.side);
  if (!begins()) return false;
  copy_in(device_, cells_, cells.nodes, n);
  device_.set_bytes(told_.device, 0, 1);
  launch_visits(device_, SowCell{cells_.device, piles_}, static_cast<std::int32_t>(n));
  const Cells graph{{{&cells_.device->cost, 2}, cells.robot, cells.beyond},
                    {cells_.device, cells.side + 2 * field::CellGraph::kRing}};
  if (!read_settled(graph, cells_, n)) return false;
  std::memcpy(cells.nodes, cells_.host, n * sizeof *cells.nodes);
  return true;
}

}  // namespace jaywalk
