#include <chrono>
#include <cmath>
#include <memory>
#include <vector>

#include "drivers/laser/serial_scanners.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::lms200;
using namespace std::chrono_literals;
using Octets = std::vector<std::uint8_t>;

namespace {

/// What the scanner sends: address 80h, and its status at the end of the body.
Octets telegram(const Octets& body) {
  Octets made{0x02, 0x80, static_cast<std::uint8_t>(body.size()), static_cast<std::uint8_t>(body.size() >> 8U)};
  made.insert(made.end(), body.begin(), body.end());
  const std::uint16_t crc = crc16(made);
  made.push_back(static_cast<std::uint8_t>(crc));
  made.push_back(static_cast<std::uint8_t>(crc >> 8U));
  return made;
}

/// `count` values in the unit that `head` says beside it: 100, 101, ... counts.
Octets values(unsigned count, unsigned head = 0, std::uint8_t status = 0x10) {
  Octets body{0xB0, static_cast<std::uint8_t>(count | head), static_cast<std::uint8_t>((count | head) >> 8U)};
  for (unsigned k = 0; k < count; ++k) {
    body.push_back(static_cast<std::uint8_t>(100 + k));
    body.push_back(static_cast<std::uint8_t>((100 + k) >> 8U));
  }
  body.push_back(status);
  return body;
}

}  // namespace

TEST_CASE("the CRC of an LMS200 takes each byte with the one before it") {
  // 02h: 0002h. 01h: shifted 0004h, xor 0201h: 0205h.
  CHECK(crc16(Octets{0x02}) == 0x0002);
  CHECK(crc16(Octets{0x02, 0x01}) == 0x0205);
  // 80h: 0080h; 00h: 0100h xor 8000h = 8100h; 00h: 0200h xor 8005h = 8205h.
  CHECK(crc16(Octets{0x80, 0x00, 0x00}) == 0x8205);
  // The maker's examples: one scan; all, without end.
  CHECK(crc16(Octets{0x02, 0x00, 0x02, 0x00, 0x30, 0x01}) == 0x1831);
  CHECK(crc16(Octets{0x02, 0x00, 0x02, 0x00, 0x20, 0x24}) == 0x0834);
}

TEST_CASE("half a degree in centimetres becomes a scan from right to left") {
  LaserScan scan;
  Octets body = values(361);
  body[3] = 0xF7;  // value 0: 1FF7h, beyond the maximum
  body[4] = 0x1F;
  body[6] = 0x20;  // value 1: 101 with the highest flag
  REQUIRE(decode_scan(body, 500000, Time{1s}, scan) == Heard::kScan);
  REQUIRE(scan.beam_count == 361);
  CHECK(scan.first_angle_rad == Approx(-1.5707963));
  CHECK(scan.angle_step_rad == Approx(0.0087266));
  CHECK(scan.state(0) == BeamState::kFree);
  CHECK(scan.range_m[1] == Approx(1.01));
  CHECK(scan.range_m[360] == Approx(4.60));
  CHECK(scan.range_max_m == Approx(81.82));
  // 732 bytes at 50000 a second are 14.64 ms: two turns of 13.33 ms suffice. Two turns, the second by half: 20 ms.
  CHECK(to_seconds(scan.period) == Approx(2.0 / 75.0));
  CHECK(to_seconds(scan.sweep) == Approx(1.5 / 75.0));
  CHECK(to_seconds(scan.stamp) == Approx(1.0 - 0.01464 - 0.02).epsilon(1e-6));
}

TEST_CASE("of an LMS200's codes only 'beyond the maximum' is free room, and a dazzled value proves nothing") {
  // 2000h, 4000h: in field A, in field B; 8000h: dazzled. 8186: channel 1 could not be read; 8187: too much noise;
  // 8189: overflow; 8190: dazzled; 8191: not valid.
  const std::vector<std::pair<BeamState, std::vector<unsigned>>> cases{
      {BeamState::kHit, {100, 100 | 0x2000, 100 | 0x4000, 8181}},
      {BeamState::kFree, {8183, 8183 | 0x6000}},
      {BeamState::kUnknown, {0, 8184, 8185, 8186, 8187, 8188, 8189, 8190, 8191, 100 | 0x8000, 8183 | 0x8000}}};
  for (const unsigned unit : {0U, 0x4000U}) {  // centimetres and millimetres
    for (const auto& [state, codes] : cases) {
      for (const unsigned code : codes) {
        Octets body = values(181, unit);
        body[3] = static_cast<std::uint8_t>(code);
        body[4] = static_cast<std::uint8_t>(code >> 8U);
        LaserScan scan;
        REQUIRE(decode_scan(body, 38400, Time{1s}, scan) == Heard::kScan);
        INFO(code);
        CHECK(scan.state(0) == state);
      }
    }
  }
}

TEST_CASE("a slow line makes the LMS200 leave turns out") {
  LaserScan scan;
  REQUIRE(decode_scan(values(181, 0x4000), 38400, Time{1s}, scan) == Heard::kScan);
  CHECK(scan.range_m[180] == Approx(0.28));  // millimetres
  // 372 bytes at 3840 a second are 96.9 ms: every eighth turn.
  CHECK(to_seconds(scan.period) == Approx(8.0 / 75.0));
  CHECK(to_seconds(scan.sweep) == Approx(0.5 / 75.0));
}

TEST_CASE("an LMS200's error, a part of a scan and a number of values that it cannot have give no scan") {
  LaserScan scan;
  CHECK(decode_scan(values(181, 0, 0x13), 38400, Time{1s}, scan) == Heard::kDeviceError);
  CHECK(decode_scan(values(181, 0, 0x12), 38400, Time{1s}, scan) == Heard::kScan);  // a warning
  CHECK(decode_scan(values(181, 0x2000), 38400, Time{1s}, scan) == Heard::kMalformed);
  CHECK(decode_scan(values(182), 38400, Time{1s}, scan) == Heard::kMalformed);
  CHECK(decode_scan(values(181, 0xC000), 38400, Time{1s}, scan) == Heard::kMalformed);
  CHECK(decode_scan(Octets{0xA0, 0x00, 0x10}, 38400, Time{1s}, scan) == Heard::kAnswer);
  const Octets whole = values(101);
  for (std::size_t length = 3; length < whole.size(); ++length) {
    REQUIRE(decode_scan(wire::Bytes(whole).first(length), 38400, Time{1s}, scan) == Heard::kMalformed);
  }
}

TEST_CASE("telegrams of an LMS200 are found between garbage and in pieces of any size") {
  const Octets body{0xA0, 0x00, 0x10};
  const Octets whole = telegram(body);
  Octets stream{0x06, 0x02, 0x80, 0x55, 0x44};  // an ACK, which belongs there, and a beginning that is too long
  stream.insert(stream.end(), whole.begin(), whole.end());
  Octets damaged = whole;
  damaged[5] ^= 0x40U;
  stream.insert(stream.end(), damaged.begin(), damaged.end());
  stream.insert(stream.end(), whole.begin(), whole.end());
  for (std::size_t piece = 1; piece <= stream.size(); ++piece) {
    TelegramStream telegrams;
    int found = 0;
    for (std::size_t at = 0; at < stream.size(); at += piece) {
      telegrams.append(wire::Bytes(stream).subspan(at, std::min(piece, stream.size() - at)));
      while (const auto one = telegrams.next()) found += Octets(one->begin(), one->end()) == body ? 1 : 100;
    }
    REQUIRE(found == 2);
    REQUIRE(telegrams.skipped() == 4 + damaged.size());
  }
}

TEST_CASE("an LMS200 is quieted and then told to send all") {
  Lms200Protocol protocol(38400);
  auto scan = std::make_unique<LaserScan>();
  protocol.begin();
  const wire::Bytes first = protocol.to_say(Time{0s});
  CHECK(Octets(first.begin(), first.end()) == Octets{0x02, 0x00, 0x02, 0x00, 0x20, 0x25, 0x35, 0x08});
  CHECK(crc16(first.first(6)) == 0x0835);
  CHECK(protocol.to_say(Time{0s}).empty());
  protocol.hear(telegram(values(181)));  // what it was still sending
  CHECK(protocol.next(Time{1s}, *scan) == Heard::kAnswer);
  protocol.hear(Octets{0x06});
  protocol.hear(telegram({0xA0, 0x00, 0x10}));
  CHECK(protocol.next(Time{1s}, *scan) == Heard::kAnswer);
  const wire::Bytes second = protocol.to_say(Time{1s});
  CHECK(Octets(second.begin(), second.end()) == Octets{0x02, 0x00, 0x02, 0x00, 0x20, 0x24, 0x34, 0x08});
  protocol.hear(telegram({0xA0, 0x00, 0x10}));
  CHECK(protocol.next(Time{1s}, *scan) == Heard::kAnswer);
  CHECK_FALSE(protocol.awaits_answer());
  protocol.hear(telegram(values(181)));
  CHECK(protocol.next(Time{2s}, *scan) == Heard::kScan);
  CHECK(protocol.counts().skipped_bytes == 0);
  protocol.begin();
  static_cast<void>(protocol.to_say(Time{3s}));
  protocol.hear(telegram({0xA0, 0x01, 0x10}));  // wrong password
  CHECK(protocol.next(Time{3s}, *scan) == Heard::kRefused);
}
