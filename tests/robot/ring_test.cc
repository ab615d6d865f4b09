#include <thread>

#include "firmware/robot/service_manager.h"
#include "tests/support/catch.h"

using namespace jaywalk;

TEST_CASE("a ring hands out in order, and says when it is full or empty") {
  Ring<int, 3> ring;
  CHECK(ring.front() == nullptr);
  for (int k = 1; k <= 3; ++k) {
    REQUIRE(ring.draft() != nullptr);
    *ring.draft() = k;
    ring.publish();
  }
  CHECK(ring.draft() == nullptr);
  REQUIRE(ring.front() != nullptr);
  CHECK(*ring.front() == 1);
  ring.pop();
  CHECK(*ring.front() == 2);
  CHECK(ring.draft() != nullptr);
}

TEST_CASE("between two threads nothing is lost, doubled or torn") {
  struct Pair {
    int value = 0, same = 0;
  };
  Ring<Pair, 8> ring;
  std::thread writer([&] {
    for (int k = 1; k <= 20000;) {
      Pair* const slot = ring.draft();
      if (slot == nullptr) continue;
      slot->value = slot->same = k++;
      ring.publish();
    }
  });
  int expected = 1;
  bool whole = true;
  while (expected <= 20000) {
    const Pair* const next = ring.front();
    if (next == nullptr) continue;
    whole = whole && next->value == expected && next->same == expected;
    ++expected;
    ring.pop();
  }
  writer.join();
  CHECK(whole);
}
