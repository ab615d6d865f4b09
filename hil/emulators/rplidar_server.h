#pragma once
#include <cstdint>
#include <string>

#include "hil/emulators/scanner_server.h"

namespace jaywalk::emulators {

/// An RPLIDAR A2: ten turns a second of 360 points, clockwise. It hears stop, scan, health and the motor's speed, and
/// measures while its motor runs. A new peer finds it as the last one left it.
class RplidarServer final : public ScannerServer {
 public:
  RplidarServer(std::unique_ptr<ByteServer> wire, World world);

  /// It says of itself that it is broken.
  void break_down() noexcept { status_ = 2; }
  /// Its turns begin at this angle, degrees, and end beyond 360.
  void begin_turns_at(double angle_deg) noexcept { first_q6_ = static_cast<unsigned>(64.0 * angle_deg); }

 private:
  void on_new_peer() override {}
  void on_bytes(wire::Bytes bytes) override;
  std::vector<std::uint8_t> message_of(std::size_t first_beam, std::span<const float> range_m, Time began,
                                       Time now) override;
  void obey(std::uint8_t command);

  std::vector<std::uint8_t> came_in_;
  bool motor_runs_ = false;
  std::uint8_t status_ = 0;
  unsigned first_q6_ = 0;
};

}  // namespace jaywalk::emulators
