#pragma once
// A block of a kernel's threads, on one thread of the CPU: each runs up to its next barrier, in random order.
#include <cstddef>
#include <cstdint>
#include <functional>
#include <random>
#include <vector>

namespace jaywalk::emulated {

using OrderRandom = std::minstd_rand;  ///< of blocks and threads: the same seed gives the same order

/// The numbers 0 to n - 1, shuffled.
[[nodiscard]] std::vector<unsigned> in_random_order(std::size_t n, OrderRandom& random);

inline constexpr std::size_t kMostThreads = 1024;  ///< of a block (CUDA C++ Programming Guide, table 21)

/// Runs `kernel` for each thread, and counts the barriers that open. False where some threads never reach a barrier.
[[nodiscard]] bool run_block(std::size_t threads, const std::function<void()>& kernel, OrderRandom& random,
                             std::int64_t& barriers);

/// Called by a kernel: waits until all threads of the block have called it.
void meet_block();

/// CUDA's indices of the running thread, those that the project's kernels use.
struct Index {
  unsigned x = 1;
};
inline Index threadIdx, blockIdx, blockDim;

}  // namespace jaywalk::emulated
