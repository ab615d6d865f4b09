#pragma once
// One launch of a kernel: its threads as fibers that run, in random order, from barrier to barrier.
#include <cstdint>
#include <functional>
#include <vector>

#include "cuda/emulated/fibers.h"
#include "cuda/emulated/shared_memory.h"

namespace jaywalk::emulated {

/// As CUDA's: x runs fastest.
struct Extent {
  unsigned x = 1, y = 1, z = 1;
  [[nodiscard]] std::size_t count() const { return std::size_t{x} * y * z; }
  [[nodiscard]] Extent place(std::size_t k) const {
    return {static_cast<unsigned>(k % x), static_cast<unsigned>(k / x % y), static_cast<unsigned>(k / x / y)};
  }
};

struct Shape {
  Extent grid, block;
  unsigned cluster_blocks = 1;
  bool cooperative = false;  ///< the blocks may meet
  std::size_t dynamic_bytes = 0;
};

/// Barriers that have opened.
struct Counts {
  std::int64_t launches = 0, grid = 0, cluster = 0, block = 0, warp = 0;
};

enum class Ended : std::uint8_t {
  kWell,
  kNever,     ///< threads wait at barriers that the others do not come to
  kTooLong,   ///< more barriers than the limit
  kOffStack,  ///< a thread has used more stack than there is
};

/// xorshift64*; the same seed gives the same order.
class OrderRandom {
 public:
  explicit OrderRandom(std::uint64_t seed) : state_(seed * 2 + 1) {}
  std::uint32_t below(std::size_t n) {
    state_ ^= state_ >> 12, state_ ^= state_ << 25, state_ ^= state_ >> 27;
    return static_cast<std::uint32_t>((state_ * 0x2545f4914f6cdd1dULL >> 32) % n);
  }

 private:
  std::uint64_t state_;
};

class Launch {
 public:
  /// Runs all threads. `most_barriers`: of the grid, of clusters and of blocks together.
  Ended run(const Shape& shape, const std::function<void()>& kernel, OrderRandom& random, std::int64_t most_barriers,
            Counts& counts);

  // From inside a kernel, for the running thread.
  void meet_warp(), meet_block(), meet_cluster(), meet_grid();
  /// Meets the block; whether any of its threads voted so.
  [[nodiscard]] bool any_of_block(bool vote);
  /// Lets others go on.
  void pause();
  [[nodiscard]] const Shape& shape() const { return *shape_; }
  [[nodiscard]] std::size_t block() const { return first_ + running_ / threads_; }
  [[nodiscard]] std::size_t thread() const { return running_ % threads_; }
  /// A place that the running warp's lane `lane` writes and all of them read, between barriers of the warp.
  [[nodiscard]] std::uint64_t& lane_value(std::size_t lane) { return lane_values_[warp() * kWarp + lane]; }
  [[nodiscard]] SharedMemory& shared_memory() { return shared_; }
  static constexpr std::size_t kWarp = 32;

 private:
  struct Barrier {
    std::size_t expected = 0;
    std::vector<std::uint32_t> waiting;
  };

  /// Blocks from the `first_` on, which may meet: all of the launch, or one after the other where they may not.
  void begin(std::size_t blocks);
  Ended run_blocks(std::size_t blocks, OrderRandom& random, std::int64_t limit);
  [[nodiscard]] bool may_meet() const { return shape_->cooperative || shape_->cluster_blocks > 1; }
  [[nodiscard]] std::size_t warps_of_block() const { return (threads_ + kWarp - 1) / kWarp; }
  [[nodiscard]] std::size_t warp() const { return running_ / threads_ * warps_of_block() + thread() / kWarp; }
  /// How threads get on for a while: one block is as far ahead of the others as barriers allow, or as far behind, or in
  /// each block one warp ahead of its others.
  enum class Habit : std::uint8_t { kMixed, kAhead, kBehind, kWarpAhead };

  /// Threads to run next: of one block, of some, or of all.
  void choose(OrderRandom& random);
  /// Of one block's, those that are to run next.
  void take(std::vector<std::uint32_t>& ready);
  void resume(std::uint32_t thread);
  void meet(Barrier& barrier, std::int64_t& count);

  Fibers fibers_;
  SharedMemory shared_;
  const Shape* shape_ = nullptr;
  const std::function<void()>* kernel_ = nullptr;
  Counts* counts_ = nullptr;
  std::size_t threads_ = 0, first_ = 0, running_ = 0, ended_ = 0;
  std::vector<bool> votes_, found_;  ///< by block: in the vote under way, and in the last one
  std::vector<Barrier> warps_, blocks_, clusters_;
  Barrier grid_;
  std::vector<std::vector<std::uint32_t>> ready_;  ///< by block
  std::vector<std::uint32_t> chosen_;
  Habit habit_ = Habit::kMixed;
  std::size_t special_ = 0;       ///< the block that is ahead or behind
  std::size_t special_warp_ = 0;  ///< in each block, the warp that is ahead
  std::vector<std::uint64_t> lane_values_;
};

/// Where the running thread stands; CUDA's own names for it are aliases (include/cuda_runtime.h).
struct Here {
  Extent thread, block, block_extent, grid_extent;
};
inline Here here;
/// The launch under way.
inline Launch* launch_under_way = nullptr;

}  // namespace jaywalk::emulated
