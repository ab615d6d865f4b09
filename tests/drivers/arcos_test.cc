// What a Pioneer's board and its client say, byte by byte.
#include <string_view>
#include <vector>

#include "drivers/arcos/arcos_base.h"
#include "drivers/wired_drive.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using arcos::Command;
using Octets = std::vector<std::uint8_t>;

namespace {

Octets on_line(const arcos::Word& word) {
  const arcos::Packet packet = arcos::packet_of(word);
  return {packet.on_line().begin(), packet.on_line().end()};
}

/// x 1000 mm, y -1, heading a quarter turn; 300 and -200 mm/s; 12.5 V; the right wheel stalled; motors on.
const Octets kReport{0x33, 0xE8, 0x03, 0xFF, 0xFF, 0x00, 0x04, 0x2C, 0x01, 0x38,
                     0xFF, 0x7D, 0x00, 0x01, 0x00, 0x00, 0x01, 0x00, 0x00, 0x00};

Octets packet_with(const Octets& body) {
  const std::uint16_t sum = arcos::checksum(body);
  Octets packet{0xFA, 0xFB, static_cast<std::uint8_t>(body.size() + 2)};
  packet.insert(packet.end(), body.begin(), body.end());
  packet.push_back(static_cast<std::uint8_t>(sum >> 8U));
  packet.push_back(static_cast<std::uint8_t>(sum));
  return packet;
}

}  // namespace

// Sums by hand: 043Bh + 0100h; 0B3Bh + 2C01h; 0B1Bh + C800h; 151Bh + 0A00h.
TEST_CASE("an ARCOS command is number, type, value and the sum of its pairs") {
  CHECK(on_line({Command::kPulse}) == Octets{0xFA, 0xFB, 0x03, 0x00, 0x00, 0x00});
  CHECK(on_line({Command::kOpen}) == Octets{0xFA, 0xFB, 0x03, 0x01, 0x00, 0x01});
  CHECK(on_line({Command::kStop}) == Octets{0xFA, 0xFB, 0x03, 0x1D, 0x00, 0x1D});
  CHECK(on_line({Command::kEnable, 1}) == Octets{0xFA, 0xFB, 0x06, 0x04, 0x3B, 0x01, 0x00, 0x05, 0x3B});
  CHECK(on_line({Command::kSpeed, 300}) == Octets{0xFA, 0xFB, 0x06, 0x0B, 0x3B, 0x2C, 0x01, 0x37, 0x3C});
  CHECK(on_line({Command::kSpeed, -200}) == Octets{0xFA, 0xFB, 0x06, 0x0B, 0x1B, 0xC8, 0x00, 0xD3, 0x1B});
  CHECK(on_line({Command::kTurn, -10}) == Octets{0xFA, 0xFB, 0x06, 0x15, 0x1B, 0x0A, 0x00, 0x1F, 0x1B});
  CHECK(on_line({Command::kSonar, 0}).size() == 9);
}

TEST_CASE("ARCOS packets are found behind noise, in pieces, and after a damaged one") {
  arcos::PacketReader reader;
  Octets line{0x00, 0xFA, 0xFA, 0xFB, 0x02, 0xFB};
  Octets damaged = packet_with(kReport);
  damaged[8] ^= 1U;
  const Octets sound = packet_with(kReport);
  line.insert(line.end(), damaged.begin(), damaged.end());
  line.insert(line.end(), sound.begin(), sound.end());
  int found = 0;
  for (const std::uint8_t byte : line) {
    reader.append({&byte, 1});
    for (wire::Bytes body = reader.next(); !body.empty(); body = reader.next()) {
      CHECK(Octets(body.begin(), body.end()) == kReport);
      ++found;
    }
  }
  CHECK(found == 1);
}

TEST_CASE("an ARCOS report tells speeds, stalls, flags and motors, and a short one nothing") {
  const auto report = arcos::report_in(kReport);
  REQUIRE(report);
  CHECK(report->speed_mmps[0] == 300.0);
  CHECK(report->speed_mmps[1] == -200.0);
  CHECK(report->motors_on);
  CHECK(report->faults == arcos::kRightStall);
  Octets stopped = kReport;
  stopped[12] = 1;            // and the left one
  stopped[16] = 0x20 | 0x40;  // FLAGS 5 and 6
  const auto other = arcos::report_in(stopped);
  REQUIRE(other);
  CHECK_FALSE(other->motors_on);
  CHECK(arcos_fault_words(other->faults) == "left wheel stalled; right wheel stalled; stop button pressed; E_stall");
  CHECK_FALSE(arcos::report_in(wire::Bytes(kReport).first(17)));
  CHECK_FALSE(arcos::report_in(wire::Bytes(kReport).subspan(1)));
}

TEST_CASE("ARCOS encoders are two counts of 32 bits") {
  const Octets body{0x90, 0xFF, 0xFF, 0xFF, 0xFF, 0x00, 0x01, 0x00, 0x00};
  const auto counts = arcos::encoders_in(body);
  REQUIRE(counts);
  CHECK(*counts == arcos::Encoders{0xFFFFFFFF, 256});
  CHECK_FALSE(arcos::encoders_in(wire::Bytes(body).first(8)));
}

TEST_CASE("ARCOS settings are read to their ticks, or not at all") {
  Octets body{0x20};
  const auto add = [&body](std::string_view text) {
    body.insert(body.end(), text.begin(), text.end()), body.push_back(0);
  };
  const auto skip = [&body](std::size_t count) { body.insert(body.end(), count, 0xEE); };
  const auto two = [&body](int value) {
    body.push_back(static_cast<std::uint8_t>(value)), body.push_back(static_cast<std::uint8_t>(value >> 8));
  };
  add("Pioneer"), add("p3dx-sh"), add("1234"), skip(11), add("name");
  body.push_back(100);
  skip(11), two(2000), skip(9);
  two(100), two(750), two(60), two(61), skip(6), two(300), two(301), skip(16), two(128);
  const auto settings = arcos::settings_in(body);
  REQUIRE(settings);
  CHECK(std::string_view(settings->type.data()) == "Pioneer");
  CHECK(std::string_view(settings->subtype.data()) == "p3dx-sh");
  CHECK(settings->cycle_ms == 100);
  CHECK(settings->watchdog_ms == 2000);
  CHECK(settings->turn_top_dps == 100);
  CHECK(settings->top_mmps == 750);
  CHECK(settings->turn_acceleration_dps2 == 60);
  CHECK(settings->turn_deceleration_dps2 == 61);
  CHECK(settings->acceleration_mmps2 == 300);
  CHECK(settings->deceleration_mmps2 == 301);
  CHECK(settings->ticks_per_mm == 128);
  for (std::size_t size = 0; size < body.size(); ++size) CHECK_FALSE(arcos::settings_in(wire::Bytes(body).first(size)));
}
