#pragma once
// The graph that the time from poses is settled on: poses, and the moves between them backward.
#include <algorithm>
#include <array>
#include <cstdint>

#include "planner/cost_to_go/pose_guide.h"
#include "planner/cost_to_go/pose_price.h"

namespace jaywalk::field {

/// Graph of a PoseGuide's poses, for Shortest.
class PoseGraph {
 public:
  using Cost = std::uint16_t;
  static constexpr std::uint32_t kBucketShift = 4;  ///< 16 costs: no move costs less, in no order
  static_assert(price::kLeastCost == 1U << kBucketShift);

  /// Takes the arrays of `guide` and their `costs`. Ways end `more` beyond the cost of pose `robot`, nowhere where that
  /// is negative.
  void lay(const PoseGuide& guide, Cost* costs, std::int32_t robot, std::uint32_t more) noexcept {
    rate_ = guide.rate, unseen_ = guide.unseen, costs_ = costs, robot_ = robot, more_ = more;
    turn_moves_back(*guide.moves);
  }

  [[nodiscard]] std::int32_t robot() const noexcept { return robot_; }
  [[nodiscard]] Cost& cost(std::int32_t pose) const noexcept { return costs_[pose]; }
  [[nodiscard]] std::uint32_t limit() const noexcept {
    const std::uint32_t there = robot_ < 0 ? PoseGuide::kNoWay : costs_[robot_];
    return there == PoseGuide::kNoWay ? there : std::min<std::uint32_t>(there + more_ + 1, PoseGuide::kNoWay);
  }
  template <class May, class Visit>
  void for_each_step(std::int32_t pose, const May& may, const Visit& visit) const noexcept {
    const auto to = static_cast<std::size_t>(PoseLattice::heading_of(pose));
    const std::uint32_t rate = rate_[pose], eighths = unseen_ == nullptr ? 0U : unseen_[pose];
    for (std::int32_t k = 0; k < count_[to]; ++k) {
      const Move& move = back_[to][static_cast<std::size_t>(k)];
      const std::int32_t from = pose + move.offset;
      if (!may(costs_[from], move.cost)) continue;  // nowhere is less dear than the open
      const std::uint32_t other = rate_[from];
      if (other != 0) visit(from, price::cost_of(move.cost, rate, other, eighths, move.unseen_weight));
    }
  }

 private:
  /// Move backward: from the pose that it leads to.
  struct Move {
    std::int32_t offset;  ///< of poses
    std::uint32_t cost, unseen_weight;
  };

  void turn_moves_back(const PoseMoves& moves) noexcept {
    count_.fill(0);
    for (std::int32_t from = 0; from < PoseLattice::kHeadings; ++from) {
      for (std::int32_t m = 0; m < moves.count[static_cast<std::size_t>(from)]; ++m) {
        const PoseMove& move = moves.from[static_cast<std::size_t>(from)][static_cast<std::size_t>(m)];
        const auto to = static_cast<std::size_t>(PoseLattice::wrapped(from + move.turn));
        if (static_cast<std::size_t>(count_[to]) == back_[to].size()) continue;
        back_[to][static_cast<std::size_t>(count_[to]++)] = {
            (from - static_cast<std::int32_t>(to)) * PoseLattice::kPlane - move.dj * PoseLattice::kStride - move.di,
            move.cost, price::unseen_weight(move.gear, move.turn)};
      }
    }
  }

  const std::uint8_t *rate_ = nullptr, *unseen_ = nullptr;
  Cost* costs_ = nullptr;
  std::int32_t robot_ = -1;
  std::uint32_t more_ = 0;
  std::array<std::array<Move, 2 * PoseMoves::kMost>, PoseLattice::kHeadings> back_{};
  std::array<std::int32_t, PoseLattice::kHeadings> count_{};
};

}  // namespace jaywalk::field
