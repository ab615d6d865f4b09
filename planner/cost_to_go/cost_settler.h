#pragma once
// The time to go's long work as plain values, for the processor's loops and queues or for a device: poses, the moves
// between them backward, their room, rates and costs; costs of cells.
#include <algorithm>
#include <cstdint>

#include "planner/cost_to_go/cell_graph.h"
#include "planner/cost_to_go/pose_guide.h"

namespace jaywalk::field {

/// The moves backward, by the heading that they lead to; plain values.
struct BackMoves {
  static constexpr std::int32_t kMost = 2 * PoseMoves::kMost;
  struct Move {
    std::int32_t offset;  ///< of poses
    std::uint32_t cost, unseen_weight;
  };

  void turn_back(const PoseMoves& moves) noexcept {
    std::fill_n(count, PoseLattice::kHeadings, 0);
    for (std::int32_t from = 0; from < PoseLattice::kHeadings; ++from) {
      for (std::int32_t m = 0; m < moves.count[static_cast<std::size_t>(from)]; ++m) {
        const PoseMove& move = moves.from[static_cast<std::size_t>(from)][static_cast<std::size_t>(m)];
        const std::int32_t heading = PoseLattice::wrapped(from + move.turn);
        if (count[heading] == kMost) continue;
        to[heading][count[heading]++] = {PoseLattice::offset(-move.di, -move.dj, from - heading), move.cost,
                                         price::unseen_weight(move.gear, move.turn)};
      }
    }
  }

  Move to[PoseLattice::kHeadings][kMost];
  std::int32_t count[PoseLattice::kHeadings];
};

/// The steps to poses that a pose may be come to from, on the processor and on a device; plain values.
struct PoseSteps {
  static constexpr std::uint32_t kNone = PoseGuide::kNoWay, kSpan = 128;  ///< half a second in the open

  const BackMoves* moves = nullptr;
  const std::uint8_t *rate = nullptr, *unseen = nullptr;  ///< as PoseGuide has them

  [[nodiscard]] JAYWALK_CELL std::int32_t count(std::int32_t pose) const {
    return moves->count[PoseLattice::heading_of(pose)];
  }
  /// The k-th of them. may(from, least) is asked first: what the step costs is the dearer question, and nowhere is less
  /// dear than the open.
  template <class May, class Visit>
  JAYWALK_CELL void step(std::int32_t pose, std::int32_t k, const May& may, const Visit& visit) const {
    const BackMoves::Move& move = moves->to[PoseLattice::heading_of(pose)][k];
    const std::int32_t from = pose + move.offset;
    if (!may(from, move.cost)) return;
    const std::uint32_t other = rate[from];
    if (other == 0) return;
    visit(from,
          price::cost_of(move.cost, rate[pose], other, unseen == nullptr ? 0U : unseen[pose], move.unseen_weight));
  }
  /// Poses at this cost or beyond it are not stepped from: `more` beyond a cost.
  [[nodiscard]] JAYWALK_CELL static std::uint32_t end(std::uint32_t there, std::uint32_t more) {
    return there + more + 1 < kNone ? there + more + 1 : kNone;
  }
};

/// Nodes at which the room of a body's outline is read, by each one's distance to the nearest surface: plain values. A
/// pose stands for the place in its cell, across its heading, with the most room.
struct PoseLook {
  static constexpr std::int32_t kSides = 3;    ///< a cell's middle, to the left, to the right
  static constexpr std::int32_t kPerCell = 4;  ///< nodes
  static constexpr std::int32_t kMargin = 60;  ///< a body reaches 1.5 m from its axle at most
  static constexpr std::int32_t kNodes = PoseLattice::kSide * kPerCell + 2 * kMargin, kColumns = kNodes / kPerCell;

  const std::uint8_t* nodes;   ///< every fourth of a row side by side
  const std::int32_t* places;  ///< of the node of each heading's, side's and point's, for cell (0, 0)
  const std::uint8_t* radius;  ///< of each point: of a circle within the body; 0: of the outline
  std::int32_t points;
  std::uint8_t* room;  ///< by pose
  std::int8_t* shift;  ///< to the left

  JAYWALK_CELL static std::int8_t shift_of(std::int32_t side) {
    return static_cast<std::int8_t>(side == 2 ? -1 : side);
  }
  JAYWALK_CELL static std::uint8_t left(std::uint8_t node, std::uint8_t radius) {
    return static_cast<std::uint8_t>((node > radius ? node : radius) - radius);
  }

  /// Visits a pose: cells run fastest.
  JAYWALK_CELL void operator()(std::int32_t k) const {
    const std::int32_t i = k % PoseLattice::kSide, j = k / PoseLattice::kSide % PoseLattice::kSide,
                       heading = k / (PoseLattice::kSide * PoseLattice::kSide);
    const std::int32_t pose = PoseLattice::at(i, j, heading), cell = j * kPerCell * kColumns + i;
    for (std::int32_t side = 0; side < kSides; ++side) {
      const std::int32_t* at = places + (heading * kSides + side) * points;
      std::uint8_t least = 255;
      for (std::int32_t p = 0; p < points; ++p) {
        const std::uint8_t there = left(nodes[at[p] + cell], radius[p]);
        least = there < least ? there : least;
      }
      if (side > 0 && least <= room[pose]) continue;
      room[pose] = least, shift[pose] = shift_of(side);
    }
  }
};

/// Price of a second at each pose, in 1/kRateOfOpen; 0: the body cannot be there. A body that stands nearer to
/// something than there is a way may leave: near it, what has no less room is open.
struct PoseRates {
  static constexpr std::int32_t kOpenCells = 6, kOpenTurns = 6, kUneven = 1;  ///< of room: along a straight wall

  const std::uint8_t* of_room;  ///< by all 256
  std::uint8_t dearest;         ///< where it may leave
  const std::uint8_t* room;     ///< by pose, PoseLook's
  const std::uint8_t* dearer;   ///< beside pedestrians that stand; null: there are none
  std::int32_t robot;           ///< pose; negative: none
  std::uint8_t* rate;

  /// Visits a pose.
  JAYWALK_CELL void operator()(std::int32_t pose) const {
    std::uint32_t price = of_room[room[pose]];
    if (price == 0 && is_by_robot(pose, kOpenCells, kOpenTurns)) price = price_to_leave(pose);
    if (price != 0 && dearer != nullptr) price += dearer[pose];
    rate[pose] = static_cast<std::uint8_t>(price < 255 ? price : 255);
  }

 private:
  using Lattice = PoseLattice;

  [[nodiscard]] JAYWALK_CELL bool is_by_robot(std::int32_t pose, std::int32_t cells, std::int32_t turns) const {
    const std::int32_t rows = Lattice::offset(0, cells + 1, 0);  // nearly all poses are farther off
    if (robot < 0 || pose < robot - rows || pose > robot + rows) return false;
    const std::int32_t i = Lattice::i_of(pose), j = Lattice::j_of(pose), di = i - Lattice::i_of(robot),
                       dj = j - Lattice::j_of(robot),
                       turn = Lattice::wrapped(Lattice::heading_of(pose) - Lattice::heading_of(robot) + turns);
    return di >= -cells && di <= cells && dj >= -cells && dj <= cells && turn <= 2 * turns && i >= 0 && j >= 0 &&
           i < Lattice::kSide && j < Lattice::kSide;
  }
  [[nodiscard]] JAYWALK_CELL std::uint32_t price_to_leave(std::int32_t pose) const {
    std::int32_t most = 0;
    for (std::int32_t dj = -1; dj <= 1; ++dj) {
      for (std::int32_t di = -1; di <= 1; ++di) {
        for (std::int32_t turn = -1; turn <= 1; ++turn) {
          const std::int32_t heading = Lattice::wrapped(Lattice::heading_of(robot) + turn),
                             there = Lattice::at(Lattice::i_of(robot) + di, Lattice::j_of(robot) + dj, heading);
          most = is_by_robot(there, 1, 1) && room[there] > most ? room[there] : most;
        }
      }
    }
    return of_room[most] == 0 && room[pose] + kUneven >= most ? dearest : 0U;
  }
};

/// The poses' room, their rates from that, and cost[p] = min(cost[q] + step(p, q)) over the moves p to q.
struct PoseCosts {
  PoseLook look;
  PoseRates rates;
  PoseSteps steps;
  std::int32_t robot;    ///< pose; negative: none
  std::uint32_t beyond;  ///< more than the robot's cost: of no concern
  std::uint16_t* cost;   ///< what is given, else PoseGuide::kNoWay; then the fixed point, where that is of concern
};

/// cost[n] = min(cost[c] + step) over sixteen neighbours.
struct CellCosts {
  std::int32_t side;
  std::int32_t robot;    ///< node
  std::uint32_t beyond;  ///< more than the robot's cost: of no concern
  CellNode* nodes;  ///< CellGraph's; cost: what is given, else kNoWay; then the fixed point, where that is of concern
};

/// A device for them. Host and device give the same numbers.
class CostSettler {
 public:
  CostSettler() = default;
  virtual ~CostSettler() = default;
  CostSettler(const CostSettler&) = delete;
  CostSettler& operator=(const CostSettler&) = delete;
  /// True where it may be asked, again after a failure.
  [[nodiscard]] virtual bool is_ready() noexcept = 0;
  /// Why it has failed since it was ready last; empty where it has not.
  [[nodiscard]] virtual const char* failure() const noexcept = 0;
  /// Time that it has taken in all, ms, by the device's own clock.
  [[nodiscard]] virtual double took_ms() const noexcept = 0;
  [[nodiscard]] virtual const char* name() const noexcept = 0;
  /// False: it failed, and nothing has been written.
  [[nodiscard]] virtual bool settle(const PoseCosts& poses) noexcept = 0;
  [[nodiscard]] virtual bool settle(const CellCosts& cells) noexcept = 0;
};

}  // namespace jaywalk::field
