#include "hal/mailbox.h"

#include <thread>

#include "tests/support/catch.h"

using namespace jaywalk;

TEST_CASE("a mailbox hands out the newest and never tears it") {
  struct Pair {
    long a = 0, b = 0;
  };
  Mailbox<Pair> box;
  CHECK(box.latest().a == 0);
  constexpr long kLast = 200000;
  std::thread writer([&] {
    for (long k = 1; k <= kLast; ++k) box.publish({k, -k});
  });
  long seen = 0;
  while (seen < kLast) {
    const Pair& p = box.latest();
    REQUIRE(p.a == -p.b);
    REQUIRE(p.a >= seen);
    seen = p.a;
  }
  writer.join();
}
