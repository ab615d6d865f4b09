#include <chrono>
#include <cmath>
#include <memory>
#include <vector>

#include "drivers/laser/serial_scanners.h"
#include "tests/drivers/random_bytes.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::rplidar;
using namespace std::chrono_literals;
using Octets = std::vector<std::uint8_t>;

namespace {

const Octets kScanDescriptor{0xA5, 0x5A, 0x05, 0x00, 0x00, 0x40, 0x81};
const Octets kHealthDescriptor{0xA5, 0x5A, 0x03, 0x00, 0x00, 0x00, 0x06};

/// Quality 15; `angle_q6` in 64ths of a degree, `range_q2` in quarters of a millimetre.
Octets node(bool begins, unsigned angle_q6, unsigned range_q2) {
  return {static_cast<std::uint8_t>(15U << 2U | (begins ? 1U : 2U)), static_cast<std::uint8_t>(angle_q6 << 1U | 1U),
          static_cast<std::uint8_t>(angle_q6 >> 7U), static_cast<std::uint8_t>(range_q2),
          static_cast<std::uint8_t>(range_q2 >> 8U)};
}

/// A turn of 180 points, every second degree from half a degree on, as far away as `range_m`.
Octets turn(double range_m) {
  Octets made;
  for (unsigned k = 0; k < 180; ++k) {
    const Octets one = node(k == 0, 32 + 128 * k, static_cast<unsigned>(range_m * 4000.0));
    made.insert(made.end(), one.begin(), one.end());
  }
  return made;
}

Octets said(wire::Bytes bytes) { return {bytes.begin(), bytes.end()}; }

/// A conversation up to where nodes come.
std::unique_ptr<RplidarProtocol> scanning() {
  auto protocol = std::make_unique<RplidarProtocol>();
  LaserScan scan;
  protocol->begin();
  static_cast<void>(protocol->to_say(Time{0s}));
  static_cast<void>(protocol->to_say(Time{20ms}));
  protocol->hear(kHealthDescriptor);
  protocol->hear(Octets{0, 0, 0});
  REQUIRE(protocol->next(Time{30ms}, scan) == Heard::kAnswer);
  REQUIRE(said(protocol->to_say(Time{30ms})) == Octets{0xA5, 0x20});
  protocol->hear(kScanDescriptor);
  REQUIRE(protocol->next(Time{40ms}, scan) == Heard::kAnswer);
  REQUIRE_FALSE(protocol->awaits_answer());
  return protocol;
}

}  // namespace

TEST_CASE("a point of an RPLIDAR is an angle in 64ths of a degree and quarters of a millimetre") {
  // 3Eh: quality 15, no new turn. 45.5 degrees are 2912 = 0B60h: low seven bits 60h and the check bit C1h, high 16h.
  // 1.25 m are 5000 = 1388h.
  const auto point = decode_node(Octets{0x3E, 0xC1, 0x16, 0x88, 0x13});
  REQUIRE(point);
  CHECK(point->angle_deg == 45.5);
  CHECK(point->range_m == Approx(1.25));
  CHECK_FALSE(decode_node(Octets{0x3F, 0xC1, 0x16, 0x88, 0x13}));         // begins and does not
  CHECK_FALSE(decode_node(Octets{0x3E, 0xC0, 0x16, 0x88, 0x13}));         // check bit
  const auto beyond = decode_node(Octets{0x3E, 0x41, 0xB4, 0x88, 0x13});  // 180 x 128 / 64 + 1/2 = 360.5 degrees
  REQUIRE(beyond);
  CHECK(beyond->angle_deg == 0.5);
  CHECK_FALSE(decode_node(Octets{0x3E, 0x01, 0xC0, 0x88, 0x13}));  // 384 degrees
  CHECK_FALSE(decode_node(Octets{0x3E, 0xC1, 0x16, 0x88}));
}

TEST_CASE("an RPLIDAR is stopped first, then its motor runs, it says how it is, and turns become scans") {
  RplidarProtocol protocol;
  LaserScan scan;
  protocol.begin();
  CHECK(said(protocol.to_say(Time{0s})) == Octets{0xA5, 0x25});
  CHECK_FALSE(protocol.awaits_answer());
  protocol.hear(turn(1.0));  // what it was still sending
  CHECK(protocol.next(Time{5ms}, scan) == Heard::kNothing);
  CHECK(protocol.to_say(Time{19ms}).empty());
  // Motor: A5h xor F0h xor 02h xor 94h xor 02h = C1h.
  CHECK(said(protocol.to_say(Time{20ms})) == Octets{0xA5, 0xF0, 0x02, 0x94, 0x02, 0xC1, 0xA5, 0x52});
  CHECK(protocol.awaits_answer());
  protocol.hear(wire::Bytes(kHealthDescriptor).first(6));
  CHECK(protocol.next(Time{25ms}, scan) == Heard::kNothing);
  protocol.hear(wire::Bytes(kHealthDescriptor).last(1));
  CHECK(protocol.next(Time{25ms}, scan) == Heard::kNothing);
  protocol.hear(Octets{0, 0, 0});
  CHECK(protocol.next(Time{25ms}, scan) == Heard::kAnswer);
  CHECK(said(protocol.to_say(Time{25ms})) == Octets{0xA5, 0x20});
  protocol.hear(kScanDescriptor);
  CHECK(protocol.next(Time{30ms}, scan) == Heard::kAnswer);
  protocol.hear(turn(1.0));
  CHECK(protocol.next(Time{100ms}, scan) == Heard::kNothing);
  protocol.hear(turn(2.0));
  CHECK(protocol.next(Time{200ms}, scan) == Heard::kNothing);  // the first turn was seen in part, as far as it knows
  protocol.hear(turn(3.0));
  REQUIRE(protocol.next(Time{300ms}, scan) == Heard::kScan);
  CHECK(scan.beam_count == 360);
  CHECK(scan.stamp == Time{200ms});
  CHECK(scan.sweep == 100ms);
  CHECK(scan.range_m[90] == Approx(2.0));  // to the right
  CHECK(scan.angle_rad(90) == Approx(-90.5 * 3.14159265 / 180.0));
  CHECK_FALSE(scan.is_hit(91));  // points lie at every second degree
  CHECK(protocol.counts().skipped_bytes == 0);
}

TEST_CASE("after lost and foreign bytes an RPLIDAR's points are found again and the torn turn is not handed out") {
  const auto protocol = scanning();
  auto scan = std::make_unique<LaserScan>();
  Time now{1s};
  const auto hear = [&](Octets bytes) {
    protocol->hear(bytes);
    int scans = 0;
    for (Heard heard = protocol->next(now, *scan); heard != Heard::kNothing; heard = protocol->next(now, *scan)) {
      scans += heard == Heard::kScan ? 1 : 0;
    }
    now += 100ms;
    return scans;
  };
  CHECK(hear(turn(1.0)) == 0);
  CHECK(hear(turn(2.0)) == 0);
  CHECK(hear(turn(3.0)) == 1);
  Octets torn = turn(4.0);
  torn.erase(torn.begin() + 451, torn.begin() + 454);  // within the 91st node
  torn.insert(torn.begin() + 600, {0xFF, 0xFF, 0xFF, 0xFF});
  CHECK(hear(torn) == 1);  // the turn of 3 m
  CHECK(hear(turn(5.0)) == 0);
  CHECK(hear(turn(6.0)) == 1);
  CHECK(scan->range_m[90] == Approx(5.0));
  CHECK(protocol->counts().skipped_bytes > 0);
}

TEST_CASE("any bytes from an RPLIDAR make scans within their limits") {
  const auto protocol = scanning();
  auto scan = std::make_unique<LaserScan>();
  tests::RandomBytes random(41);
  const Octets good = turn(2.0);
  int scans = 0;
  std::uint64_t heap_calls = 0;
  for (int k = 0; k < 3000; ++k) {
    const Octets bytes = random.below(3) == 0 ? random.bytes(random.below(300)) : random.damaged(good);
    const AllocationGuard guard;
    protocol->hear(bytes);
    for (Heard heard = protocol->next(Time{k * 1ms}, *scan); heard != Heard::kNothing;
         heard = protocol->next(Time{k * 1ms}, *scan)) {
      scans += heard == Heard::kScan ? 1 : 0;
      if (scan->beam_count != 360 || scan->sweep < 0s || !std::isfinite(scan->range_m[7])) scans = -1000000;
    }
    heap_calls += guard.calls();
  }
  CHECK(scans > 0);
  CHECK(heap_calls == 0);
}
