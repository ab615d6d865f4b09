#include <cstring>
#include <type_traits>

#include "cuda/cuda_cost_to_go.h"
#include "planner/cost_to_go/cell_graph.h"
#include "planner/cost_to_go/pose_guide.h"

namespace jaywalk {
namespace {

/// Costs of all nodes, where ways end: beyond that of a node, negative: nowhere, and the steps between nodes.
template <class Steps>
struct Graph {
  static constexpr std::uint32_t kNone = Steps::kNone, kSpan = Steps::kSpan;
  static constexpr int kThreads = 16;
  LoweredCosts costs;
  std::int32_t robot;
  std::uint32_t beyond;
  Steps steps;

  [[nodiscard]] __device__ std::uint32_t limit() const {
    return Steps::end(robot < 0 ? kNone : costs.peek(robot), beyond);
  }
  [[nodiscard]] __device__ std::int32_t count(std::int32_t n) const { return steps.count(n); }
  template <class May, class Visit>
  __device__ void step(std::int32_t n, std::int32_t k, const May& may, const Visit& visit) const {
    steps.step(n, k, may, visit);
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

constexpr std::size_t kPoses = PoseLattice::kPoses, kRooms = 256;

/// Null for null.
template <class T>
T* copy_in(CudaDevice& device, const Shared<T>& to, const T* from, std::size_t n) noexcept {
  if (from == nullptr) return nullptr;
  std::memcpy(to.host, from, n * sizeof(T));
  device.copy_in(to, n);
  return to.device;
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

template <class G, class T>
bool CudaCostToGo::read_settled(const G& graph, const Shared<T>& settled, std::size_t n) noexcept {
  device_.launch(settle_piles<G>, 1, kPileThreads, graph, piles_);
  if constexpr (std::is_same_v<T, std::uint16_t>)
    device_.launch_visits(ReapPose{wide_cost_, settled.device}, 1, PoseLattice::kPoses);
  device_.copy_out(settled, n);
  device_.copy_out(told_, 1);
  return device_.wait() && told_.host->full == 0;
}

bool CudaCostToGo::settle(const field::PoseCosts& poses) noexcept {
  constexpr std::int32_t kCellPoses = PoseLattice::kHeadings * PoseLattice::kSide * PoseLattice::kSide;
  const auto points = static_cast<std::size_t>(poses.look.points);
  if (points > kMostPoints || !begins()) return false;
  const field::PoseLook look{copy_in(device_, nodes_, poses.look.nodes, kNodes),
                             copy_in(device_, places_, poses.look.places, kLooks * points),
                             copy_in(device_, radius_, poses.look.radius, points),
                             poses.look.points,
                             room_.device,
                             shift_.device};
  const field::PoseRates rates{
      copy_in(device_, rate_of_room_, poses.rates.of_room, kRooms), poses.rates.dearest, room_.device,
      copy_in(device_, dearer_, poses.rates.dearer, kPoses),        poses.robot,         pose_rate_.device};
  const field::PoseSteps steps{copy_in(device_, moves_, poses.steps.moves, 1), pose_rate_.device,
                               copy_in(device_, unseen_, poses.steps.unseen, kPoses)};
  const std::uint16_t* const given = copy_in(device_, pose_cost_, poses.cost, kPoses);
  device_.set_bytes(told_.device, 0, 1);
  device_.launch_visits(look, 1, kCellPoses);
  device_.launch_visits(SowPose{rates, given, wide_cost_, piles_}, 1, PoseLattice::kPoses);
  device_.copy_out(room_, kPoses), device_.copy_out(shift_, kPoses), device_.copy_out(pose_rate_, kPoses);
  const Graph<field::PoseSteps> graph{{wide_cost_, 1}, poses.robot, poses.beyond, steps};
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
  device_.launch_visits(SowCell{cells_.device, piles_}, 1, static_cast<std::int32_t>(n));
  const Graph<field::CellSteps> graph{
      {&cells_.device->cost, 2}, cells.robot, cells.beyond, {cells_.device, cells.side + 2 * field::CellGraph::kRing}};
  if (!read_settled(graph, cells_, n)) return false;
  std::memcpy(cells.nodes, cells_.host, n * sizeof *cells.nodes);
  return true;
}

}  // namespace jaywalk
