#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "drivers/laser/scip.h"
#include "drivers/laser/serial_scanners.h"
#include "drivers/laser/sick.h"
#include "drivers/ros/ros_scan.h"
#include "tests/drivers/fuzz/fuzz_targets.h"

namespace jaywalk::tests {

namespace {

void check_scan(Heard decoding, const LaserScan& scan) {
  if (decoding != Heard::kScan) return;
  require(scan.beam_count <= kMaxBeams);
  require(scan.stamp <= kArrival && scan.sweep >= Duration{0} && scan.period >= Duration{0});
  // Infinity is free room; NaN is said by none, and minus infinity only of the robot itself (blank()).
  for (std::uint32_t beam = 0; beam < scan.beam_count; ++beam) {
    require(!std::isnan(scan.range_m[beam]) && !scan.too_near(beam));
  }
}

/// Checks a decoder that takes one message as a whole.
void check_decoded(Heard decoding, const LaserScan& scan) {
  require(decoding != Heard::kNothing);
  require(decoding != Heard::kScan || scan.period > Duration{0});
  check_scan(decoding, scan);
}

/// Filled again and again: what a refused scan leaves in it must not matter.
LaserScan& reused_scan() {
  static LaserScan scan;
  return scan;
}

/// The first byte, which chooses what is done with the others.
std::uint8_t take_choice(wire::Bytes& bytes) {
  if (bytes.empty()) return 0;
  const std::uint8_t choice = bytes.front();
  bytes = bytes.subspan(1);
  return choice;
}

/// A whole conversation: what the scanner sends comes in pieces, and what is to be said is said in between.
void converse(ScannerProtocol& protocol, wire::Bytes bytes) {
  protocol.begin();
  Time now = kArrival;
  while (!bytes.empty()) {
    static_cast<void>(protocol.to_say(now));
    const std::size_t count = std::min<std::size_t>(bytes.size(), 1 + take_choice(bytes));
    protocol.hear(bytes.first(std::min(count, bytes.size())));
    bytes = bytes.subspan(std::min(count, bytes.size()));
    now += std::chrono::milliseconds(count);
    LaserScan& scan = reused_scan();
    for (Heard heard = protocol.next(now, scan); heard != Heard::kNothing; heard = protocol.next(now, scan)) {
      if (heard == Heard::kScan) require(scan.beam_count <= kMaxBeams && scan.stamp <= now);
    }
  }
}

}  // namespace

/// An even first byte: a body as it stands; an odd one: a stream of telegrams. The second bit chooses the dialect.
void fuzz_sick(wire::Bytes bytes) {
  static std::array<sick::ColaStream, 2> streams{sick::ColaStream(sick::Cola::kA), sick::ColaStream(sick::Cola::kB)};
  LaserScan& scan = reused_scan();
  sick::ScanHeader header;
  const std::uint8_t choice = take_choice(bytes);
  const std::size_t which = (choice >> 1U) & 1U;
  const sick::Cola dialect = which == 0 ? sick::Cola::kA : sick::Cola::kB;
  if ((choice & 1U) == 0) return check_decoded(decode_scan(dialect, bytes, {}, kArrival, scan, header), scan);
  streams[which].begin(dialect);
  streams[which].append(bytes);
  while (const auto body = streams[which].next()) {
    check_decoded(decode_scan(dialect, *body, {}, kArrival, scan, header), scan);
  }
}

void fuzz_scip(wire::Bytes bytes) {
  static scip::AnswerStream stream;
  LaserScan& scan = reused_scan();
  std::uint32_t device_time_ms = 0;
  stream.clear();
  stream.append(bytes);
  while (const auto answer = stream.next()) {
    check_decoded(scip::decode_scan(*answer, {}, kArrival, scan, device_time_ms), scan);
    scip::ScannerModel model;
    if (!scip::decode_model(*answer, model)) continue;
    require(model.steps_per_turn > 0 && model.period > Duration{0} && model.first_step < model.last_step);
  }
}

void fuzz_ldrobot(wire::Bytes bytes) {
  static ldrobot::PacketStream as_it_came, with_right_checksums;
  LaserScan& scan = reused_scan();
  ldrobot::SweepBuilder builder;
  as_it_came.clear();
  with_right_checksums.clear();
  as_it_came.append(bytes);
  while (const auto packet = as_it_came.next()) {
    require(packet->first_angle_cdeg < 36000 && packet->last_angle_cdeg < 36000);
    if (builder.add(*packet, kArrival, scan)) check_scan(Heard::kScan, scan);
  }
  // So that what lies behind the checksum is tried as well.
  for (; bytes.size() >= ldrobot::kPacketBytes; bytes = bytes.subspan(ldrobot::kPacketBytes)) {
    std::array<std::uint8_t, ldrobot::kPacketBytes> made{0x54, 0x2C};
    std::copy_n(bytes.begin() + 2, made.size() - 3, made.begin() + 2);
    made.back() = ldrobot::crc8(wire::Bytes(made).first(made.size() - 1));
    with_right_checksums.append(made);
    while (const auto packet = with_right_checksums.next()) {
      require(packet->first_angle_cdeg < 36000 && packet->last_angle_cdeg < 36000);
      if (builder.add(*packet, kArrival, scan)) check_scan(Heard::kScan, scan);
    }
  }
}

/// An even first byte: a body as it stands; an odd one: a stream of telegrams.
void fuzz_lms200(wire::Bytes bytes) {
  static lms200::TelegramStream stream;
  LaserScan& scan = reused_scan();
  const std::uint8_t choice = take_choice(bytes);
  if ((choice & 1U) == 0) return check_decoded(lms200::decode_scan(bytes, 38400, kArrival, scan), scan);
  stream.clear();
  stream.append(bytes);
  while (const auto body = stream.next()) check_decoded(lms200::decode_scan(*body, 38400, kArrival, scan), scan);
}

/// The beginning of a message from a shared ring; the lowest bit of the first byte: infinity is free.
void fuzz_ros(wire::Bytes bytes) {
  static std::array<std::uint8_t, ros::kScanRing.message_bytes> message;
  LaserScan& scan = reused_scan();
  const bool infinity_is_free = (take_choice(bytes) & 1U) != 0;
  message.fill(0);
  std::copy_n(bytes.begin(), std::min(bytes.size(), message.size()), message.begin());
  for (const wire::Bytes each : {wire::Bytes(message), bytes}) {
    const bool is_scan = ros::decode_scan(each, kArrival, infinity_is_free, scan) == Heard::kScan;
    if (is_scan) check_scan(Heard::kScan, scan);
  }
}

void fuzz_scanner_protocol(wire::Bytes bytes) {
  static sick::SickProtocol in_text(sick::Cola::kA, {}), in_binary(sick::Cola::kB, {});
  static scip::ScipProtocol hokuyo;
  static ldrobot::LdProtocol ldrobot;
  static rplidar::RplidarProtocol rplidar;
  static lms200::Lms200Protocol lms200(38400);
  const std::array<ScannerProtocol*, 6> all{&in_text, &in_binary, &hokuyo, &ldrobot, &rplidar, &lms200};
  converse(*all[take_choice(bytes) % all.size()], bytes);
}

}  // namespace jaywalk::tests
