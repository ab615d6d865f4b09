#include "drivers/laser/rplidar.h"

namespace jaywalk::rplidar {
namespace {

/// A turn's last points may lie beyond its end, by less than the widest step between two at the fewest points a turn.
constexpr double kMostAngle_deg = 370.0;

}  // namespace

std::optional<Descriptor> decode_descriptor(wire::Bytes bytes) noexcept {
  wire::ByteReader reader(bytes);
  const bool begins = reader.little<std::uint8_t>() == 0xA5 && reader.little<std::uint8_t>() == 0x5A;
  const auto length_and_mode = reader.little<std::uint32_t>();  // the two highest bits are the mode
  const auto type = reader.little<std::uint8_t>();
  if (!reader.ok() || !begins) return std::nullopt;
  return Descriptor{length_and_mode & 0x3FFFFFFFU, length_and_mode >> 30U == 1, type};
}

std::optional<Node> decode_node(wire::Bytes bytes) noexcept {
  wire::ByteReader reader(bytes);
  const auto first = reader.little<std::uint8_t>();
  const auto angle = reader.little<std::uint16_t>();
  const auto range = reader.little<std::uint16_t>();
  const bool begins = (first & 1U) != 0;
  const bool begins_not = (first & 2U) != 0;
  if (!reader.ok() || begins == begins_not || (angle & 1U) == 0) return std::nullopt;
  double angle_deg = (angle >> 1U) / 64.0;
  if (angle_deg >= kMostAngle_deg) return std::nullopt;
  if (angle_deg >= 360.0) angle_deg -= 360.0;
  return Node{begins, static_cast<std::uint8_t>(first >> 2U), angle_deg, static_cast<float>(range) * 0.00025F};
}

}  // namespace jaywalk::rplidar
