#include <cstdlib>

#include "drivers/arcos/arcos_base.h"

namespace jaywalk::arcos {
namespace {

constexpr std::uint8_t kFirst = 0xFA, kSecond = 0xFB;
constexpr std::size_t kHead = 3, kSum = 2;
constexpr std::uint8_t kPositive = 0x3B, kNegative = 0x1B;
constexpr std::uint8_t kReports = 0x30, kSettingsBody = 0x20, kEncodersBody = 0x90;
constexpr std::uint16_t kMotorsOn = 1, kStallBits = 0x0101, kFaultFlags = 0x0060;

bool takes_argument(Command command) noexcept {
  return command > Command::kClose && command != Command::kStop && command != Command::kEmergencyStop;
}

std::array<char, 24> text(wire::ByteReader& reader) noexcept {
  std::array<char, 24> read{};
  for (std::size_t k = 0;; ++k) {
    const auto letter = static_cast<char>(reader.little<std::uint8_t>());
    if (letter == 0) return read;
    if (k + 1 < read.size()) read[k] = letter;
  }
}

}  // namespace

std::uint16_t checksum(wire::Bytes body) noexcept {
  std::uint32_t sum = 0;
  for (; body.size() > 1; body = body.subspan(2)) sum += wire::big_endian<std::uint16_t>(body);
  if (!body.empty()) sum = (sum & 0xFFFFU) ^ body[0];
  return static_cast<std::uint16_t>(sum);
}

Packet packet_of(const Word& word) noexcept {
  Packet packet{{kFirst, kSecond, 0, static_cast<std::uint8_t>(word.command)}, kHead + 1};
  if (takes_argument(word.command)) {
    packet.bytes[packet.size] = word.argument < 0 ? kNegative : kPositive;
    const auto size = static_cast<std::uint16_t>(std::abs(word.argument));
    wire::put_little_endian(size, std::span(packet.bytes).subspan(packet.size + 1));
    packet.size += 3;
  }
  const std::uint16_t sum = checksum(packet.on_line().subspan(kHead));
  wire::put_big_endian(sum, std::span(packet.bytes).subspan(packet.size));
  packet.size += kSum;
  packet.bytes[2] = static_cast<std::uint8_t>(packet.size - kHead);
  return packet;
}

std::vector<CanFrame> stop_frames() {
  std::vector<CanFrame> frames;
  in_frames(packet_of({Command::kStop}).on_line(), [&frames](const CanFrame& frame) { frames.push_back(frame); });
  return frames;
}

wire::Bytes PacketReader::next() noexcept {
  for (;;) {
    const wire::Bytes rest = waiting();
    if (rest.size() < kHead) return {};
    const std::size_t count = rest[2];
    const bool begins = rest[0] == kFirst && rest[1] == kSecond && count > kSum;
    if (begins && rest.size() < kHead + count) return {};
    const wire::Bytes body = begins ? rest.subspan(kHead, count - kSum) : wire::Bytes();
    if (begins && wire::big_endian<std::uint16_t>(rest.subspan(kHead + count - kSum)) == checksum(body)) {
      drop(kHead + count);
      return body;
    }
    skip(1);
  }
}

std::optional<Report> report_in(wire::Bytes body) noexcept {
  wire::ByteReader reader(body);
  const auto type = reader.little<std::uint8_t>();
  reader.take(6);  // x, y, heading: the encoders tell more
  Report report;
  for (double& speed : report.speed_mmps) speed = static_cast<std::int16_t>(reader.little<std::uint16_t>());
  reader.take(1);  // battery
  const auto stalls = reader.little<std::uint16_t>();
  reader.take(2);  // set point of its heading
  const auto flags = reader.little<std::uint16_t>();
  if (!reader.ok() || (type & 0xF0U) != kReports) return std::nullopt;
  report.faults = (stalls & kStallBits) | static_cast<std::uint32_t>(flags & kFaultFlags) << 16U;
  report.motors_on = (flags & kMotorsOn) != 0;
  return report;
}

std::optional<Encoders> encoders_in(wire::Bytes body) noexcept {
  wire::ByteReader reader(body);
  const auto type = reader.little<std::uint8_t>();
  const auto left = reader.little<std::uint32_t>(), right = reader.little<std::uint32_t>();
  if (!reader.ok() || type != kEncodersBody) return std::nullopt;
  return Encoders{left, right};
}

std::optional<Settings> settings_in(wire::Bytes body) noexcept {
  wire::ByteReader reader(body);
  const auto type = reader.little<std::uint8_t>();
  Settings settings{.type = text(reader), .subtype = text(reader)};
  text(reader);     // serial number
  reader.take(11);  // unused; fastest that can be set: turn, speed, their ramps; PWM
  text(reader);     // name
  settings.cycle_ms = reader.little<std::uint8_t>();
  reader.take(11);  // baud of two lines, gripper, sonars, low battery, ticks of a turn
  settings.watchdog_ms = reader.little<std::uint16_t>();
  reader.take(9);  // packets, stall's PWM and time, joystick's speeds
  settings.turn_top_dps = reader.little<std::uint16_t>();
  settings.top_mmps = reader.little<std::uint16_t>();
  settings.turn_acceleration_dps2 = reader.little<std::uint16_t>();
  settings.turn_deceleration_dps2 = reader.little<std::uint16_t>();
  reader.take(6);  // gains
  settings.acceleration_mmps2 = reader.little<std::uint16_t>();
  settings.deceleration_mmps2 = reader.little<std::uint16_t>();
  reader.take(16);  // gains, bumpers, charger, sonar's cycle, baud after a reset, gyro, drift, two lines
  settings.ticks_per_mm = reader.little<std::uint16_t>();
  if (!reader.ok() || type != kSettingsBody) return std::nullopt;
  return settings;
}

}  // namespace jaywalk::arcos
