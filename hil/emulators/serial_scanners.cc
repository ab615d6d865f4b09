#include <array>
#include <cmath>

#include "hal/types/trig.h"
#include "hil/emulators/scanners.h"

namespace jaywalk::emulators {
namespace {

constexpr std::size_t kPacketPoints = 12, kPackets = 38, kBeams = kPacketPoints * kPackets;
constexpr double kStep_deg = 360.0 / kBeams;

constexpr std::size_t kPoints = 360, kTogether = 8;

constexpr std::size_t kFanBeams = 181, kTelegram = 4 + 3 + 2 * kFanBeams + 1 + 2, kCommand = 8;
constexpr double kMirror_hz = 75.0;

SweepShape fan(std::uint32_t baud) {
  const double on_line_s = kTelegram * 10.0 / baud;
  return {.beams = kFanBeams,
          .first_angle_rad = -kPi / 2.0,
          .angle_step_rad = kPi / 180.0,
          .rate_hz = kMirror_hz / std::ceil(on_line_s * kMirror_hz),
          .sweep = duration_from_seconds(0.5 / kMirror_hz),
          .on_line = duration_from_seconds(on_line_s)};
}

/// As the maker's example in C has it: the byte before goes in as high byte.
std::uint16_t check(const std::vector<std::uint8_t>& bytes) {
  std::uint32_t sum = 0;
  for (std::size_t k = 0; k < bytes.size(); ++k) {
    sum *= 2;
    if (sum >= 0x10000) sum = (sum - 0x10000) ^ 0x8005U;
    sum ^= bytes[k] + (k > 0 ? 256U * bytes[k - 1] : 0U);
  }
  return static_cast<std::uint16_t>(sum);
}

}  // namespace

LdServer::LdServer(std::unique_ptr<ByteServer> wire, World world)
    : ScannerServer(std::move(wire), whole_turn(kBeams), kPacketPoints, std::move(world)) {}

ScannerServer::Message LdServer::message_of(std::size_t first_beam, Ranges range_m, Time, Time now) {
  std::vector<std::uint8_t> packet{0x54, 0x2C};
  const auto word = [&packet](double value) { put(packet, static_cast<std::uint16_t>(value), 2); };
  word(360.0 * kTurnsPerS);
  word(100.0 * kStep_deg * static_cast<double>(first_beam) + 0.5);
  for (const float m : range_m) {
    // 0 for nothing in reach as for nothing measured: it has no other word.
    word(m > 0.0F && m <= 12.0F ? static_cast<double>(m) * 1000.0 + 0.5 : 0.0);
    packet.push_back(200);  // how strong the return was
  }
  word(100.0 * kStep_deg * static_cast<double>(first_beam + kPacketPoints - 1) + 0.5);
  put(packet, std::chrono::duration_cast<std::chrono::milliseconds>(now.time_since_epoch()).count() % 30000, 2);
  put(packet, crc(packet, 8, 0x14D), 1);  // x^8 + x^6 + x^3 + x^2 + 1
  return packet;
}

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
    case 0x25: return set_streaming(false);
    case 0xF0: motor_runs_ = true; return;
    case 0x52:
      return answer(std::array<std::uint8_t, 10>{0xA5, 0x5A, 0x03, 0x00, 0x00, 0x00, 0x06, status_, 0x00, 0x00});
    case 0x20:
      if (status_ == 2) return;
      answer(std::array<std::uint8_t, 7>{0xA5, 0x5A, 0x05, 0x00, 0x00, 0x40, 0x81});
      return set_streaming(motor_runs_);
    default: return;
  }
}

ScannerServer::Message RplidarServer::message_of(std::size_t first_beam, Ranges range_m, Time, Time) {
  std::vector<std::uint8_t> message;
  for (std::size_t k = 0; k < range_m.size(); ++k) {
    const auto angle_q6 = first_q6_ + static_cast<unsigned>(first_beam + k) * 64U;  // a degree a point
    const auto range_q2 = range_m[k] > 0.0F && range_m[k] <= 16.0F ? in_counts(range_m[k], 0.00025) : 0U;
    const bool begins = first_beam + k == 0;
    const unsigned quality = range_q2 > 0 ? 47 : 0;
    put(message, {{quality << 2U | (begins ? 1U : 2U), 1}, {angle_q6 << 1U | 1U, 2}, {range_q2, 2}});
  }
  return message;
}

Lms200Server::Lms200Server(std::unique_ptr<ByteServer> wire, std::uint32_t baud, World world)
    : ScannerServer(std::move(wire), fan(baud), kFanBeams, std::move(world)) {}

bool Lms200Server::set_window(Window window) {
  status_ = window == Window::kClean ? 0x00 : window == Window::kSoiled ? 0x82 : 0x83;
  return true;
}

void Lms200Server::on_bytes(wire::Bytes bytes) {
  came_in_.insert(came_in_.end(), bytes.begin(), bytes.end());
  while (came_in_.size() >= kCommand) {
    const bool change_mode = came_in_[0] == 0x02 && came_in_[2] == 2 && came_in_[4] == 0x20;
    const std::uint8_t mode = came_in_[5];
    came_in_.erase(came_in_.begin(), came_in_.begin() + (change_mode ? kCommand : 1));
    if (!change_mode) continue;
    set_streaming(mode == 0x24);
    std::vector<std::uint8_t> told{0x06};  // ACK
    const auto done = framed(std::array<std::uint8_t, 2>{0xA0, 0x00});
    told.insert(told.end(), done.begin(), done.end());
    answer(told);
  }
}

std::vector<std::uint8_t> Lms200Server::framed(std::span<const std::uint8_t> body) const {
  std::vector<std::uint8_t> made{0x02, 0x80};
  put(made, static_cast<std::int64_t>(body.size()) + 1, 2);
  made.insert(made.end(), body.begin(), body.end());
  made.push_back(status_);
  put(made, check(made), 2);
  return made;
}

ScannerServer::Message Lms200Server::message_of(std::size_t, Ranges range_m, Time, Time) {
  std::vector<std::uint8_t> body{0xB0, kFanBeams, 0x00};
  for (const float m : range_m) {
    constexpr unsigned kBeyond = 8183, kDazzled = 8190;
    const unsigned cm = m > 80.0F ? kBeyond : m > 0.0F ? in_counts(m, 0.01) : kDazzled;
    put(body, cm, 2);
  }
  return framed(body);
}

}  // namespace jaywalk::emulators
