#pragma once
// A block of a kernel's threads, on one thread of the CPU: each runs up to its next barrier, in random order.
#include <cstddef>
#include <cstdint>
#include <functional>
#include <random>
#include <vector>

namespace jaywalk::emulated {

using OrderRandom = std::minstd_rand;  ///< of blocks and threads: the same seed gives the same order

/// 0 to n - 1.
[[nodiscard]] std::vector<unsigned> in_random_order(std::size_t n, OrderRandom& random);

inline constexpr std::size_t kMostThreads = 1024;  ///< of a block (CUDA C++ Programming Guide, table 21)

/// Runs `kernel` for each thread, and counts the barriers that open. False: threads wait at one that the others do not
/// come to.
[[nodiscard]] bool run_block(std::size_t threads, const std::function<void()>& kernel, OrderRandom& random,
                             std::int64_t& barriers);

/// From inside a kernel: waits for the block's other threads. Whether any of them has voted so.
bool meet_block(bool vote);

/// CUDA's names for where the running thread stands, as far as the project's kernels use them.
struct Index {
  unsigned x = 1;
};
inline Index threadIdx, blockIdx, blockDim;

}  // namespace jaywalk::emulated
