#include "tests/support/allocation_guard.h"

#include <atomic>
#include <cstdlib>
#include <memory>
#include <thread>
#include <vector>

#include "tests/support/catch.h"

using namespace jaywalk;

namespace {
// The compiler may drop a new whose pointer nobody sees.
std::atomic<void*> seen = nullptr;

struct alignas(64) CacheLine {
  double values[8];
};

template <class Act>
std::uint64_t calls_of(const Act& act) {
  const AllocationGuard guard;
  act();
  return guard.calls();
}

void make_and_drop() { seen = std::make_unique<int>(1).get(); }
}  // namespace

TEST_CASE("arithmetic on the stack asks nothing of the heap") {
  const AllocationGuard guard;
  double sum = 0.0;
  for (int k = 1; k <= 1000; ++k) sum += 1.0 / k;
  const auto calls = guard.calls();
  CHECK(calls == 0);
  CHECK(sum == Approx(7.485470860550345));  // the thousandth harmonic number
}

TEST_CASE("new, over-aligned new, malloc and calloc are counted, and giving back too, but not of nothing") {
  CHECK(calls_of(make_and_drop) == 2);
  CHECK(calls_of([] { seen = std::make_unique<CacheLine>().get(); }) == 2);
  CHECK(calls_of([] { std::free(seen = std::malloc(16)); }) == 2);
  CHECK(calls_of([] { std::free(seen = std::calloc(4, 4)); }) == 2);
  CHECK(calls_of([] { std::free(nullptr); }) == 0);
}

TEST_CASE("a vector that grows is caught") {
  std::vector<int> numbers;
  numbers.reserve(4);
  const AllocationGuard guard;
  for (int k = 0; k < 4; ++k) numbers.push_back(k);
  const auto within_capacity = guard.calls();
  numbers.push_back(4);
  seen = numbers.data();
  const auto beyond_capacity = guard.calls();
  CHECK(within_capacity == 0);
  CHECK(beyond_capacity == 2);  // a new block taken, the old one given back
}

TEST_CASE("other threads do not count") {
  seen = nullptr;
  std::uint64_t there = 0;
  std::thread other([&there] { there = calls_of(make_and_drop); });
  const AllocationGuard guard;
  while (seen == nullptr) std::this_thread::yield();
  const auto here = guard.calls();
  other.join();
  CHECK(here == 0);
  CHECK(there == 2);
}
