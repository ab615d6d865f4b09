#include "firmware/robot/realtime.h"

#include <sys/mman.h>

#include <memory>

#include "tests/support/catch.h"

using namespace jaywalk;

TEST_CASE("a run that is refused priority or locked memory does not start, unless it is told otherwise") {
  const std::vector<std::string> refused{
      "no real-time priority: Operation not permitted; run as root, or raise rtprio: ulimit -r 99"};
  CHECK_THROWS_WITH(require_realtime({}, refused),
                    refused.front() + "; or start without it: --allow-no-realtime, or [realtime] required = false");
  CHECK_NOTHROW(require_realtime({}, {}));
  CHECK_NOTHROW(require_realtime({.required = false}, refused));
}

TEST_CASE("a page that is touched for the first time is a fault of the thread that touches it") {
  constexpr std::size_t kPages = 64, kPage = 4096;
  void* const room = ::mmap(nullptr, kPages * kPage, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  REQUIRE(room != MAP_FAILED);
  ::madvise(room, kPages * kPage, MADV_NOHUGEPAGE);
  const PageFaults before = page_faults();
  for (std::size_t page = 0; page < kPages; ++page) static_cast<volatile char*>(room)[page * kPage] = 1;
  const PageFaults touched = page_faults().since(before);
  CHECK(touched.minor >= kPages);
  ::munmap(room, kPages * kPage);
}
