#include <cmath>
#include <limits>
#include <memory>
#include <tuple>
#include <vector>

#include "drivers/laser/scanner_protocol.h"
#include "drivers/laser/serial_scanners.h"
#include "hal/types/trig.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::ldrobot;
using namespace std::chrono_literals;
using Octets = std::vector<std::uint8_t>;

namespace {

/// The example of the maker's LD19 manual.
const Octets kManual{0x54, 0x2C, 0x68, 0x08, 0xAB, 0x7E, 0xE0, 0x00, 0xE4, 0xDC, 0x00, 0xE2, 0xD9, 0x00, 0xE5, 0xD5,
                     0x00, 0xE3, 0xD3, 0x00, 0xE4, 0xD0, 0x00, 0xE9, 0xCD, 0x00, 0xE4, 0xCA, 0x00, 0xE2, 0xC7, 0x00,
                     0xE9, 0xC5, 0x00, 0xE5, 0xC2, 0x00, 0xE5, 0xC0, 0x00, 0xE5, 0xBE, 0x82, 0x3A, 0x1A, 0x50};

/// Twelve points from `first_deg` on, 0.8 degrees apart, at ten turns a second.
Packet packet_at(double first_deg, std::uint16_t range_mm) {
  Packet packet;
  packet.speed_degps = 3600;
  packet.first_angle_cdeg = static_cast<std::uint16_t>(first_deg * 100.0 + 0.5);
  packet.last_angle_cdeg = static_cast<std::uint16_t>((packet.first_angle_cdeg + 880) % 36000);
  packet.range_mm.fill(range_mm);
  return packet;
}

}  // namespace

TEST_CASE("the manual's packet decodes to its values") {
  const auto found = decode_packet(kManual);
  REQUIRE(found);
  const Packet& packet = *found;
  CHECK(crc8(wire::Bytes(kManual).first(46)) == 0x50);
  CHECK(packet.speed_degps == 2152);
  CHECK(packet.first_angle_cdeg == 32427);
  CHECK(packet.last_angle_cdeg == 33470);
  CHECK(packet.range_mm[0] == 224);
  CHECK(packet.range_mm[11] == 192);
  CHECK(packet.time_ms == 0x1A3A);
}

TEST_CASE("a flipped bit anywhere in a packet is noticed") {
  for (std::size_t bit = 0; bit < 8 * kPacketBytes; ++bit) {
    Octets flipped = kManual;
    flipped[bit / 8] ^= static_cast<std::uint8_t>(1U << (bit % 8));
    REQUIRE_FALSE(decode_packet(flipped));
  }
}

TEST_CASE("packets are found between garbage and in pieces of any size") {
  Octets stream{0x54, 0x2C, 0x54};
  stream.insert(stream.end(), kManual.begin(), kManual.end());
  stream.insert(stream.end(), kManual.begin(), kManual.begin() + 20);  // one that was cut off
  stream.insert(stream.end(), kManual.begin(), kManual.end());
  stream.insert(stream.end(), kManual.begin(), kManual.end());
  for (std::size_t piece = 1; piece <= stream.size(); ++piece) {
    PacketStream packets;
    int found = 0;
    for (std::size_t at = 0; at < stream.size(); at += piece) {
      packets.append(wire::Bytes(stream).subspan(at, std::min(piece, stream.size() - at)));
      while (packets.next()) ++found;
    }
    REQUIRE(found == 3);
    REQUIRE(packets.skipped() == 23);
  }
}

TEST_CASE("a whole turn becomes a scan that turns clockwise and the part of a turn before it does not") {
  SweepBuilder builder;
  auto scan = std::make_unique<LaserScan>();
  // 12 points by 0.8 degrees: a packet covers 9.6 degrees, 37.5 of them a turn, each 9.6/3600 s after the one before.
  int scans = 0;
  std::uint64_t heap_calls = 0;
  for (int k = 0; k < 100; ++k) {
    const double at = 180.0 + 9.6 * k;
    const double turned = at - 360.0 * static_cast<int>(at / 360.0);
    const Time arrival = time_from_seconds(1.0 + 9.6 / 3600.0 * k + 8.8 / 3600.0);
    const Packet packet = packet_at(turned + 0.4, turned > 80.4 && turned < 90.0 ? 500 : 2000);
    const AllocationGuard guard;
    if (builder.add(packet, arrival, *scan)) ++scans;
    heap_calls += guard.calls();
  }
  // 960 degrees from 180: it passes ahead at 180 and 540 degrees turned, and at 900.
  CHECK(scans == 2);
  CHECK(heap_calls == 0);
  REQUIRE(scan->beam_count == 450);
  CHECK(scan->angle_step_rad == Approx(-0.01396263));  // 0.8 degrees
  int hits = 0;
  for (std::size_t beam = 0; beam < 450; ++beam) hits += scan->is_hit(beam) ? 1 : 0;
  CHECK(hits == 450);
  CHECK(to_seconds(scan->period) == Approx(0.1).epsilon(0.02));
  // 540 degrees after 1.0 s at 3600 deg/s.
  CHECK(to_seconds(scan->stamp) == Approx(1.15).epsilon(0.001));
  // The near thing is to the right: clockwise 90 degrees are 112.5 beams, at angle -90.
  CHECK(scan->range_m[112] == Approx(0.5F));
  CHECK(scan->angle_rad(112) == Approx(-kPi / 2).epsilon(0.01));
  CHECK(scan->range_m[337] == Approx(2.0F));
}

TEST_CASE(
    "a sector is free only where every point of it found nothing in reach, and its nearest hit outweighs the rest") {
  SweepBuilder builder;
  auto scan = std::make_unique<LaserScan>();
  CHECK_FALSE(builder.add(packet_at(350.4, 0), Time{1s}, *scan));
  Packet first = packet_at(0.4, 13000), second = packet_at(0.4, 13000);  // 13 m: beyond the data sheet's 12
  second.range_mm[1] = 0;
  first.range_mm[2] = 0;
  second.range_mm[3] = 3000;
  first.range_mm[4] = 3000;
  first.range_mm[5] = 0;
  second.range_mm[5] = 3000;
  first.range_mm[6] = 3000;
  second.range_mm[6] = 0;
  first.range_mm[7] = second.range_mm[7] = 0;
  first.range_mm[8] = second.range_mm[8] = second.range_mm[9] = 5;  // nearer than the scanner can see
  first.range_mm[9] = first.range_mm[10] = 3000;
  second.range_mm[10] = 1000;
  CHECK_FALSE(builder.add(first, Time{1003ms}, *scan));
  CHECK_FALSE(builder.add(second, Time{1003ms}, *scan));
  CHECK_FALSE(builder.add(packet_at(350.4, 0), Time{1100ms}, *scan));
  REQUIRE(builder.add(packet_at(0.4, 0), Time{1103ms}, *scan));
  CHECK(scan->state(0) == BeamState::kFree);
  for (const std::size_t beam : {1U, 2U, 7U, 8U}) CHECK(scan->state(beam) == BeamState::kUnknown);
  for (const std::size_t beam : {3U, 4U, 5U, 6U, 9U}) CHECK(scan->range_m[beam] == Approx(3.0F));
  CHECK(scan->range_m[10] == Approx(1.0F));
  for (std::size_t beam = 12; beam < 430; ++beam) REQUIRE(scan->state(beam) == BeamState::kUnknown);  // no point at all
}

TEST_CASE("sectors that a scanner only steps over, as it turns a tenth too fast or not evenly, are not lost") {
  auto scan = std::make_unique<LaserScan>();
  for (const double turns_per_second : {9.9, 10.0, 10.05, 10.1, 10.5, 11.0}) {
    SweepBuilder builder;
    const double step_deg = 360.0 * turns_per_second / 4500.0;
    int scans = 0;
    for (int k = 0; k < 40 * 20; ++k) {
      const double first_deg = std::fmod(12.0 * step_deg * k, 360.0);
      Packet packet = packet_at(first_deg, 2000);
      packet.speed_degps = static_cast<std::uint16_t>(360.0 * turns_per_second);
      packet.last_angle_cdeg = static_cast<std::uint16_t>(std::fmod(first_deg + 11.0 * step_deg, 360.0) * 100.0);
      if (!builder.add(packet, time_from_seconds(12.0 * k / 4500.0), *scan)) continue;
      ++scans;
      INFO(turns_per_second);
      // Only where a turn begins and ends is the sector beside a point not known to have been stepped over.
      for (std::size_t beam = 1; beam < 449; ++beam) REQUIRE(scan->range_m[beam] == Approx(2.0F));
    }
    CHECK(scans >= 18);
  }
}

TEST_CASE("a sector that was stepped over takes the nearer of its neighbours, and nothing where one is unknown") {
  TurnBuilder turn(450, 0.02F, 12.0F);
  auto scan = std::make_unique<LaserScan>();
  const auto point = [&](double in_sectors, float range_m) {
    return turn.add(in_sectors * 0.8, range_m, Time{1s}, *scan);
  };
  const float infinite = std::numeric_limits<float>::infinity();
  CHECK_FALSE(point(449.5, 0.0F));
  for (const auto& [beside, before_m, after_m] : {std::tuple{10, 3.0F, 2.0F},
                                                  {20, 2.0F, infinite},
                                                  {30, infinite, infinite},
                                                  {40, 2.0F, 0.0F},
                                                  {50, 0.0F, infinite}}) {
    CHECK_FALSE(point(beside + 0.9, before_m));
    CHECK_FALSE(point(beside + 2.2, after_m));
  }
  CHECK_FALSE(point(60.5, 2.0F));
  CHECK_FALSE(point(62.5, 2.0F));  // too long a step: one is missing between
  CHECK_FALSE(point(449.5, 0.0F));
  REQUIRE(point(0.5, 0.0F));
  CHECK(scan->range_m[11] == 2.0F);
  CHECK(scan->range_m[21] == 2.0F);
  CHECK(scan->state(31) == BeamState::kFree);
  for (const std::size_t beam : {41U, 51U, 61U}) CHECK(scan->state(beam) == BeamState::kUnknown);
}
