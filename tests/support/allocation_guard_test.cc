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
  CHECK(calls_of([&] { numbers.assign(4, 1); }) == 0);
  CHECK(calls_of([&] { numbers.push_back(4); }) == 2);  // a new block taken, the old one given back
  seen = numbers.data();
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
