#include "drivers/laser/sick.h"

#include <array>
#include <cstdio>
#include <span>
#include <string>

#include "tests/support/allocation_guard.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::sick;
using namespace std::chrono_literals;
using Octets = std::vector<std::uint8_t>;

namespace {

Octets octets(const std::string& text) { return {text.begin(), text.end()}; }

/// A field of a telegram as both dialects write it.
class Body {
 public:
  Body() { text_ = "sSN LMDscandata"; }
  Body& number(std::uint32_t value, int bytes) {
    char digits[16];
    std::snprintf(digits, sizeof digits, " %X", static_cast<unsigned>(value));
    text_ += digits;
    for (int shift = 8 * (bytes - 1); shift >= 0; shift -= 8)
      binary_.push_back(static_cast<std::uint8_t>(value >> shift));
    return *this;
  }
  Body& word(const std::string& letters) {
    text_ += " " + letters;
    binary_.insert(binary_.end(), letters.begin(), letters.end());
    return *this;
  }
  [[nodiscard]] Octets in(Cola dialect) const {
    if (dialect == Cola::kA) return octets(text_);
    Octets body = octets("sSN LMDscandata ");
    body.insert(body.end(), binary_.begin(), binary_.end());
    return body;
  }

 private:
  std::string text_;
  Octets binary_;
};

/// Beams with these counts for distances, from -45 degrees of SICK by 1 degree at 25 Hz.
Body beams_of(std::span<const std::uint32_t> counts, std::uint32_t status, std::uint32_t offset = 0) {
  Body body;
  body.number(1, 2).number(1, 2).number(0x119FD06, 4).number(0, 1).number(status, 1);
  body.number(0xAFB1, 2).number(0xAFB5, 2).number(1000, 4).number(5000, 4);
  body.number(0, 1).number(0, 1).number(8, 1).number(0, 1).number(0, 2).number(2500, 4).number(0xA2, 4);
  body.number(0, 2).number(1, 2).word("DIST1").number(0x3F800000, 4).number(offset, 4);
  body.number(static_cast<std::uint32_t>(-450000), 4).number(10000, 2);
  body.number(static_cast<std::uint32_t>(counts.size()), 2);
  for (const std::uint32_t count : counts) body.number(count, 2);
  return body;
}

/// 1.000 m, no return, 4.660 m.
Body three_beams(std::uint32_t status = 0) { return beams_of(std::array<std::uint32_t, 3>{1000, 0, 4660}, status); }

Octets framed_body(const Octets& body) {
  const ColaCommand command = framed(Cola::kB, std::string(body.begin(), body.end()));
  return {command.begin(), command.end()};
}

}  // namespace

TEST_CASE("a question is framed as the manual's examples are") {
  // TiM manual: sRN LMDscandata, 15 letters, XOR 05h.
  const std::string head("\x02\x02\x02\x02\x00\x00\x00\x0F", 8);
  const ColaCommand binary = framed(Cola::kB, "sRN LMDscandata");
  CHECK(std::string(binary.begin(), binary.end()) == head + "sRN LMDscandata\x05");
  const ColaCommand text = framed(Cola::kA, "sEN LMDscandata 1");
  CHECK(std::string(text.begin(), text.end()) == "\x02sEN LMDscandata 1\x03");
  CHECK(framed(Cola::kB, std::string(120, 'x')).empty());
}

TEST_CASE("three beams decode alike in both dialects") {
  for (const Cola dialect : {Cola::kA, Cola::kB}) {
    LaserScan scan;
    ScanHeader header;
    REQUIRE(decode_scan(dialect, three_beams().in(dialect), {}, Time{1s}, scan, header) == Heard::kScan);
    CHECK(header.telegram_counter == 0xAFB1);
    REQUIRE(scan.beam_count == 3);
    CHECK(scan.first_angle_rad == Approx(-2.3561945));  // -45 - 90 = -135 degrees
    CHECK(scan.angle_step_rad == Approx(0.0174533));    // 1 degree
    CHECK(scan.range_m[0] == Approx(1.0));
    CHECK(scan.range_m[2] == Approx(4.66));
    CHECK(scan.is_hit(0));
    CHECK_FALSE(scan.is_hit(1));
    CHECK(scan.period == 40ms);
    // Two steps of 1 degree are 2/360 of 40 ms: 0.2222 ms; held 5000 - 1000 = 4000 us.
    CHECK(to_seconds(scan.sweep) == Approx(0.00022222).epsilon(1e-4));
    CHECK(to_seconds(scan.stamp) == Approx(1.0 - 0.004 - 0.00022222).epsilon(1e-6));
  }
}

TEST_CASE("a scanner that reports an error or a dirty window gives no scan, and its warning of dirt is told") {
  for (const Cola dialect : {Cola::kA, Cola::kB}) {
    LaserScan scan;
    ScanHeader header;
    const auto of = [&](std::uint32_t status) {
      return decode_scan(dialect, three_beams(status).in(dialect), {}, Time{1s}, scan, header);
    };
    CHECK(of(1) == Heard::kDeviceError);
    CHECK(of(0) == Heard::kScan);
    CHECK_FALSE(header.warns_of_dirt);
    CHECK(of(2) == Heard::kScan);
    CHECK(header.warns_of_dirt);
    CHECK(of(4) == Heard::kDirty);
    CHECK(of(6) == Heard::kDirty);
    CHECK(of(5) == Heard::kDeviceError);
    CHECK(of(0x80) == Heard::kScan);  // without meaning in the maker's list
    CHECK_FALSE(header.warns_of_dirt);
  }
}

TEST_CASE("a SICK's reserved distances prove nothing, whatever scale and offset make of them") {
  // 0, 1, 15: reserved. 60: 6 cm. 12000: 12 m, farther than the model's 10 m. 65535: the field's end.
  constexpr std::array<std::uint32_t, 6> kCounts{0, 1, 15, 60, 12000, 0xFFFF};
  for (const Cola dialect : {Cola::kA, Cola::kB}) {
    const auto decoded = [&](std::uint32_t offset) {
      auto scan = std::make_unique<LaserScan>();
      ScanHeader header;
      const Octets body = beams_of(kCounts, 0, offset).in(dialect);
      REQUIRE(decode_scan(dialect, body, {}, Time{1s}, *scan, header) == Heard::kScan);
      return scan;
    };
    const auto plain = decoded(0);
    for (const std::size_t beam : {0U, 1U, 2U, 5U}) CHECK(plain->state(beam) == BeamState::kUnknown);
    CHECK(plain->state(3) == BeamState::kHit);
    CHECK(plain->state(4) == BeamState::kFree);
    const auto moved = decoded(0x447A0000);  // 1000 mm are added
    for (const std::size_t beam : {0U, 1U, 2U, 5U}) CHECK(moved->state(beam) == BeamState::kUnknown);
    CHECK(moved->range_m[3] == Approx(1.06F));
  }
}

TEST_CASE("answers to commands are no scans") {
  LaserScan scan;
  ScanHeader header;
  CHECK(decode_scan(Cola::kA, octets("sEA LMDscandata 1"), {}, Time{1s}, scan, header) == Heard::kAnswer);
  CHECK(decode_scan(Cola::kA, {}, {}, Time{1s}, scan, header) == Heard::kAnswer);
  CHECK(decode_scan(Cola::kA, octets("sSN LMDscandata 1 1 XYZ"), {}, Time{1s}, scan, header) == Heard::kMalformed);
}

TEST_CASE("a telegram cut off anywhere is refused") {
  const Octets whole = three_beams().in(Cola::kB);
  LaserScan scan;
  ScanHeader header;
  for (std::size_t length = 16; length < whole.size(); ++length) {
    const wire::Bytes part = wire::Bytes(whole).first(length);
    REQUIRE(decode_scan(Cola::kB, part, {}, Time{1s}, scan, header) == Heard::kMalformed);
  }
}

TEST_CASE("telegrams are found between garbage and in pieces of any size") {
  const Octets body = octets("sFA 7");
  const Octets whole = framed_body(body);
  Octets stream{0x02, 0x55, 0x02, 0x02, 0x02};  // the garbage ends like a beginning
  stream.insert(stream.end(), whole.begin(), whole.end());
  Octets damaged = whole;
  damaged[10] ^= 0x40U;
  stream.insert(stream.end(), damaged.begin(), damaged.end());
  stream.insert(stream.end(), whole.begin(), whole.end());
  for (std::size_t piece = 1; piece <= stream.size(); ++piece) {
    ColaStream telegrams(Cola::kB);
    int found = 0;
    for (std::size_t at = 0; at < stream.size(); at += piece) {
      telegrams.append(wire::Bytes(stream).subspan(at, std::min(piece, stream.size() - at)));
      while (const auto telegram = telegrams.next())
        found += Octets(telegram->begin(), telegram->end()) == body ? 1 : 100;
    }
    REQUIRE(found == 2);
    REQUIRE(telegrams.skipped() == 5 + damaged.size());
  }
}

TEST_CASE("a text telegram that was cut off does not swallow the next") {
  ColaStream telegrams(Cola::kA);
  telegrams.append(octets("noise\x02sSN LMDsc\x02sFA 7\x03\x02sEA"));
  const auto found = telegrams.next();
  REQUIRE(found);
  CHECK(std::string(found->begin(), found->end()) == "sFA 7");
  CHECK_FALSE(telegrams.next());
  CHECK(telegrams.skipped() == 5 + 10);
  telegrams.append(octets(" 1\x03"));
  const auto rest = telegrams.next();
  REQUIRE(rest);
  CHECK(std::string(rest->begin(), rest->end()) == "sEA 1");
}

TEST_CASE("a stream that never ends a telegram is given up and found again") {
  for (const Cola dialect : {Cola::kA, Cola::kB}) {
    ColaStream telegrams(dialect);
    telegrams.append({dialect == Cola::kA ? Octets{0x02} : Octets{2, 2, 2, 2, 0, 0, 0x60, 0x00}});
    for (int k = 0; k < 100; ++k) {
      telegrams.append(Octets(1000, 'x'));
      CHECK_FALSE(telegrams.next());
    }
    const ColaCommand command = framed(dialect, "sFA 7");
    telegrams.append({command.data(), command.size()});
    CHECK(telegrams.next());
  }
}
