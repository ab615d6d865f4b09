#pragma once
// One launch of a kernel: block after block in random order, each block's threads as fibers that run, in random order,
// from barrier to barrier.
#include <cstdint>
#include <functional>
#include <vector>

#include "cuda/emulated/fibers.h"

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
};

/// Launches, and barriers of a block that have opened.
struct Counts {
  std::int64_t launches = 0, block = 0;
};

enum class Ended : std::uint8_t {
  kWell,
  kNever,     ///< threads wait at a barrier that the others do not come to
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
  /// Runs all threads.
  Ended run(const Shape& shape, const std::function<void()>& kernel, OrderRandom& random, std::int64_t most_barriers,
            Counts& counts);

  // From inside a kernel, for the running thread.
  void meet_block();
  /// Meets the block; whether any of its threads voted so.
  [[nodiscard]] bool any_of_block(bool vote);

 private:
  static constexpr std::size_t kWarp = 32;

  void begin_block(std::size_t block);
  Ended run_block(OrderRandom& random, std::int64_t limit);
  /// Threads to run next: of one warp, or of all.
  void choose(OrderRandom& random);

  Fibers fibers_;
  const Shape* shape_ = nullptr;
  const std::function<void()>* kernel_ = nullptr;
  Counts* counts_ = nullptr;
  std::size_t threads_ = 0, running_ = 0, ended_ = 0;
  std::vector<std::uint32_t> ready_, waiting_, chosen_;
  std::size_t special_warp_ = 0;  ///< that gets as far ahead of the others as barriers allow, at times
  bool is_warp_ahead_ = false;
  bool vote_ = false, found_ = false;  ///< of the vote under way, and of the last one
};

/// Where the running thread stands; CUDA's own names for it are aliases (include/cuda_runtime.h).
struct Here {
  Extent thread, block, block_extent, grid_extent;
};
inline Here here;
/// The launch under way.
inline Launch* launch_under_way = nullptr;

}  // namespace jaywalk::emulated
