#include "drivers/laser/serial_scanners.h"

namespace jaywalk::ldrobot {
namespace {

constexpr std::uint8_t kHeader = 0x54, kTwelvePoints = 0x2C;
constexpr std::uint16_t kTurnCdeg = 36000;

}  // namespace

std::uint8_t crc8(wire::Bytes bytes) noexcept { return wire::crc_of<std::uint8_t>(bytes, 0x4D); }

std::optional<Packet> decode_packet(wire::Bytes bytes) noexcept {
  if (bytes.size() != kPacketBytes || bytes[0] != kHeader || bytes[1] != kTwelvePoints) return std::nullopt;
  if (crc8(bytes.first(kPacketBytes - 1)) != bytes.back()) return std::nullopt;
  Packet packet;
  wire::ByteReader reader(bytes.subspan(2));
  packet.speed_degps = reader.little<std::uint16_t>();
  packet.first_angle_cdeg = reader.little<std::uint16_t>();
  for (std::uint16_t& range_mm : packet.range_mm) {
    range_mm = reader.little<std::uint16_t>();
    reader.little<std::uint8_t>();  // intensity
  }
  packet.last_angle_cdeg = reader.little<std::uint16_t>();
  packet.time_ms = reader.little<std::uint16_t>();
  const bool in_turn = packet.first_angle_cdeg < kTurnCdeg && packet.last_angle_cdeg < kTurnCdeg;
  return in_turn ? std::optional(packet) : std::nullopt;
}

std::optional<Packet> PacketStream::next() noexcept {
  for (;;) {
    if (waiting().size() < kPacketBytes) return std::nullopt;
    const auto packet = decode_packet(waiting().first(kPacketBytes));
    packet ? drop(kPacketBytes) : skip(1);
    if (packet) return packet;
  }
}

bool SweepBuilder::add(const Packet& packet, Time arrival, LaserScan& scan) noexcept {
  if (packet.speed_degps == 0) return false;  // it does not turn: the points have no angle that could be believed
  const double first_deg = packet.first_angle_cdeg / 100.0;
  const double past_deg = (packet.last_angle_cdeg / 100.0) - first_deg;
  const double swept_deg = past_deg < 0.0 ? past_deg + 360.0 : past_deg;
  const double between_deg = swept_deg / (kPacketPoints - 1);
  bool completed = false;
  for (std::size_t k = 0; k < kPacketPoints; ++k) {
    const double turned_deg = between_deg * static_cast<double>(k);
    const double angle_deg = first_deg + turned_deg >= 360.0 ? first_deg + turned_deg - 360.0 : first_deg + turned_deg;
    const Time measured = arrival - duration_from_seconds((swept_deg - turned_deg) / packet.speed_degps);
    const float range_m = static_cast<float>(packet.range_mm[k]) * 0.001F;
    completed = turn_.add(angle_deg, range_m, measured, scan) || completed;
  }
  return completed;
}

void LdProtocol::begin() noexcept {
  stream_.clear();
  sweep_ = SweepBuilder();
  device_clock_.forget();
}

Heard LdProtocol::next(Time arrival, LaserScan& scan) noexcept {
  while (const auto packet = stream_.next()) {
    const Duration late = device_clock_.delay(packet->time_ms, arrival);
    if (sweep_.add(*packet, arrival - late, scan)) return Heard::kScan;
  }
  return Heard::kNothing;
}

}  // namespace jaywalk::ldrobot
