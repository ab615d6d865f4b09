// A crew's meetings by themselves, in the orders of 20 seeds, on three blocks. The test touches the device's memory.
#include <algorithm>
#include <cstring>
#include <span>

#include "cuda/emulated/device.h"
#include "tests/cuda/crew_kernels.h"
#include "tests/cuda/sample_kernels.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::test;

namespace {

constexpr unsigned kBlocks = 3;

template <class T>
std::span<T> device_memory(std::size_t n) {
  T* memory = nullptr;
  REQUIRE(cudaMalloc(&memory, n * sizeof(T)) == cudaSuccess);
  return {memory, n};
}

template <class Order>
void run(void (*kernel)(Order, field::CrewNotes), const Order& order) {
  const field::CrewNotes notes{device_memory<field::Counted>(field::CrewNotes::kRoom).data(),
                               device_memory<field::Counted>(field::CrewNotes::kTold).data()};
  REQUIRE(launch_sample({.blocks = kBlocks, .threads = kBlockThreads, .cooperative = true}, cudaStream_t{}, kernel,
                        order, notes) == cudaSuccess);
  REQUIRE(cudaStreamSynchronize(cudaStream_t{}) == cudaSuccess);
}

}  // namespace

TEST_CASE("emulated: all threads of a crew read what its first block, and no other, has just counted alone") {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    emulated::device().power_on({.processors = kBlocks, .seed = seed});
    const auto few = device_memory<std::int32_t>(CopyRounds::kFew);
    std::ranges::fill(few, 0);
    const auto copied = device_memory<std::int32_t>(CopyRounds::kRounds * CopyRounds::kAll);
    run(copy_rounds, CopyRounds{few.data(), copied.data()});
    for (std::int32_t r = 0; r < CopyRounds::kRounds; ++r)
      REQUIRE(std::ranges::count(copied.subspan(static_cast<std::size_t>(r) * CopyRounds::kAll, CopyRounds::kAll),
                                 r + 1) == CopyRounds::kAll);
  }
  emulated::device().power_on();
}

TEST_CASE("emulated: every thread is told each of two sums that follow one another, of its crew and of its block") {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    emulated::device().power_on({.processors = kBlocks, .seed = seed});
    const auto counted = device_memory<field::Counted>(2 * SumTwice::kPairs);
    const auto told = device_memory<std::int32_t>(4 * kBlocks * kBlockThreads);
    std::ranges::fill(counted.first(SumTwice::kPairs), field::Counted{1, 0});
    std::ranges::fill(counted.last(SumTwice::kPairs), field::Counted{2, 0});
    run(sum_twice, SumTwice{counted.data(), told.data()});
    constexpr std::int32_t kSums[] = {SumTwice::kPairs, 2 * SumTwice::kPairs, kBlockThreads, 2 * kBlockThreads};
    for (std::size_t k = 0; k < told.size(); ++k) REQUIRE(told[k] == kSums[k % 4]);
  }
  emulated::device().power_on();
}
