#include <thread>

#include "firmware/recording/recorder.h"
#include "tests/support/catch.h"

using namespace jaywalk;

TEST_CASE("a ring that is full and empty by turns hands out in order, between two threads nothing is lost or torn") {
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
