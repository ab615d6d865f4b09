#include "hil/emulators/ld_server.h"

namespace jaywalk::emulators {

namespace {

constexpr std::size_t kPacketPoints = 12, kPackets = 38, kBeams = kPacketPoints * kPackets;
constexpr double kStep_deg = 360.0 / kBeams;

/// Remainder of the polynomial x^8 + x^6 + x^3 + x^2 + 1, by long division over all bits.
std::uint8_t crc8(const std::vector<std::uint8_t>& bytes) {
  unsigned rest = 0;
  for (std::size_t bit = 0; bit < 8 * (bytes.size() + 1); ++bit) {
    const unsigned next = bit / 8 < bytes.size() ? (static_cast<unsigned>(bytes[bit / 8]) >> (7 - bit % 8)) & 1U : 0U;
    rest = rest << 1U | next;
    if ((rest & 0x100U) != 0) rest ^= 0x14DU;
  }
  return static_cast<std::uint8_t>(rest);
}

}  // namespace

LdServer::LdServer(std::unique_ptr<ByteServer> wire, World world)
    : ScannerServer(std::move(wire), whole_turn(kBeams), kPacketPoints, std::move(world)) {}

std::vector<std::uint8_t> LdServer::message_of(std::size_t first_beam, std::span<const float> range_m, Time, Time now) {
  std::vector<std::uint8_t> packet{0x54, 0x2C};
  const auto word = [&packet](double value) {
    const auto number = static_cast<std::uint16_t>(value);
    packet.push_back(static_cast<std::uint8_t>(number));
    packet.push_back(static_cast<std::uint8_t>(number >> 8U));
  };
  word(360.0 * kTurnsPerS);
  word(100.0 * kStep_deg * static_cast<double>(first_beam) + 0.5);
  for (const float m : range_m) {
    // 0 for nothing in reach as for nothing measured: it has no other word.
    word(m > 0.0F && m <= 12.0F ? static_cast<double>(m) * 1000.0 + 0.5 : 0.0);
    packet.push_back(200);  // how strong the return was
  }
  word(100.0 * kStep_deg * static_cast<double>(first_beam + kPacketPoints - 1) + 0.5);
  word(static_cast<double>(std::chrono::duration_cast<std::chrono::milliseconds>(now.time_since_epoch()).count() %
                           30000));
  packet.push_back(crc8(packet));
  return packet;
}

}  // namespace jaywalk::emulators
