#pragma once
// The graph that the time from poses is settled on: poses, and the moves between them backward.
#include <algorithm>
#include <cstdint>

#include "planner/cost_to_go/pose_guide.h"
#include "planner/cost_to_go/pose_price.h"

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

/// Graph of a PoseGuide's poses, for Shortest.
class PoseGraph {
 public:
  using Cost = std::uint16_t;
  static constexpr std::uint32_t kSpan = PoseSteps::kSpan;

  /// Takes the arrays of `guide` and their `costs`. Ways end `more` beyond the cost of pose `robot`, nowhere where that
  /// is negative.
  void lay(const PoseGuide& guide, Cost* costs, std::int32_t robot, std::uint32_t more) noexcept {
    steps_ = {&back_, guide.rate, guide.unseen};
    costs_ = costs, robot_ = robot, more_ = more;
    back_.turn_back(*guide.moves);
  }

  [[nodiscard]] const PoseSteps& steps() const noexcept { return steps_; }
  [[nodiscard]] std::int32_t robot() const noexcept { return robot_; }
  [[nodiscard]] Cost& cost(std::int32_t pose) const noexcept { return costs_[pose]; }
  [[nodiscard]] std::uint32_t limit() const noexcept {
    return PoseSteps::end(robot_ < 0 ? PoseSteps::kNone : costs_[robot_], more_);
  }
  template <class May, class Visit>
  void for_each_step(std::int32_t pose, const May& may, const Visit& visit) const noexcept {
    const std::int32_t count = steps_.count(pose);
    const auto asked = [&](std::int32_t from, std::uint32_t least) { return may(costs_[from], least); };
    for (std::int32_t k = 0; k < count; ++k) steps_.step(pose, k, asked, visit);
  }

 private:
  BackMoves back_{};
  PoseSteps steps_;
  Cost* costs_ = nullptr;
  std::int32_t robot_ = -1;
  std::uint32_t more_ = 0;
};

}  // namespace jaywalk::field
