#include "hil/emulators/lms200_server.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "hal/types/trig.h"

namespace jaywalk::emulators {

namespace {

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
  const std::size_t length = body.size() + 1;
  std::vector<std::uint8_t> made(4 + length);
  made[0] = 0x02;
  made[1] = 0x80;
  made[2] = static_cast<std::uint8_t>(length % 256);
  made[3] = static_cast<std::uint8_t>(length / 256);
  std::copy(body.begin(), body.end(), made.begin() + 4);
  made.back() = status_;
  const std::uint16_t sum = check(made);
  made.push_back(static_cast<std::uint8_t>(sum % 256));
  made.push_back(static_cast<std::uint8_t>(sum / 256));
  return made;
}

std::vector<std::uint8_t> Lms200Server::message_of(std::size_t, std::span<const float> range_m, Time, Time) {
  std::vector<std::uint8_t> body{0xB0, kFanBeams, 0x00};
  for (const float m : range_m) {
    constexpr unsigned kBeyond = 8183, kDazzled = 8190;
    const unsigned cm = m > 80.0F ? kBeyond : m > 0.0F ? in_counts(m, 0.01) : kDazzled;
    body.push_back(static_cast<std::uint8_t>(cm % 256));
    body.push_back(static_cast<std::uint8_t>(cm / 256));
  }
  return framed(body);
}

}  // namespace jaywalk::emulators
