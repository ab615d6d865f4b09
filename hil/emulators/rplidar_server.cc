#include "hil/emulators/rplidar_server.h"

#include <array>

namespace jaywalk::emulators {

namespace {

constexpr std::size_t kPoints = 360, kTogether = 8;

}  // namespace

RplidarServer::RplidarServer(std::unique_ptr<ByteServer> wire, World world)
    : ScannerServer(std::move(wire), whole_turn(kPoints), kTogether, std::move(world)) {}

void RplidarServer::on_bytes(wire::Bytes bytes) {
  came_in_.insert(came_in_.end(), bytes.begin(), bytes.end());
  while (came_in_.size() >= 2) {
    const bool begins = came_in_[0] == 0xA5;
    const bool carries = begins && (came_in_[1] & 0x80U) != 0;  // then size, that many bytes, and their checksum
    if (carries && came_in_.size() < 3) return;
    const std::size_t whole = !begins ? 1 : carries ? 4U + came_in_[2] : 2U;
    if (came_in_.size() < whole) return;
    if (begins) obey(came_in_[1]);
    came_in_.erase(came_in_.begin(), came_in_.begin() + static_cast<std::ptrdiff_t>(whole));
  }
}

void RplidarServer::obey(std::uint8_t command) {
  switch (command) {
    case 0x25:
      return set_streaming(false);
    case 0xF0:
      motor_runs_ = true;
      return;
    case 0x52:
      return answer(std::array<std::uint8_t, 10>{0xA5, 0x5A, 0x03, 0x00, 0x00, 0x00, 0x06, status_, 0x00, 0x00});
    case 0x20:
      if (status_ == 2) return;
      answer(std::array<std::uint8_t, 7>{0xA5, 0x5A, 0x05, 0x00, 0x00, 0x40, 0x81});
      return set_streaming(motor_runs_);
    default:
      return;
  }
}

std::vector<std::uint8_t> RplidarServer::message_of(std::size_t first_beam, std::span<const float> range_m, Time,
                                                    Time) {
  std::vector<std::uint8_t> message;
  for (std::size_t k = 0; k < range_m.size(); ++k) {
    const auto angle_q6 = first_q6_ + static_cast<unsigned>(first_beam + k) * 64U;  // a degree a point
    const auto range_q2 = range_m[k] > 0.0F && range_m[k] <= 16.0F ? in_counts(range_m[k], 0.00025) : 0U;
    const bool begins = first_beam + k == 0;
    const unsigned quality = range_q2 > 0 ? 47 : 0;
    for (const unsigned byte :
         {quality << 2U | (begins ? 1U : 2U), angle_q6 << 1U | 1U, angle_q6 >> 7U, range_q2, range_q2 >> 8U}) {
      message.push_back(static_cast<std::uint8_t>(byte));
    }
  }
  return message;
}

}  // namespace jaywalk::emulators
