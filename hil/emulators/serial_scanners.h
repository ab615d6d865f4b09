#pragma once
// Emulated LD19, RPLIDAR and LMS200, on a serial line.
#include <cstdint>
#include <span>
#include <vector>

#include "hil/emulators/scanner_server.h"

namespace jaywalk::emulators {

/// An LD19: ten turns a second, clockwise, 38 packets of 12 points a turn, to every listener. It obeys nothing.
class LdServer final : public ScannerServer {
 public:
  LdServer(std::unique_ptr<ByteServer> wire, World world);

 private:
  void on_new_peer() override { set_streaming(true); }
  Message message_of(std::size_t first_beam, Ranges range_m, Time began, Time now) override;
};

/// An RPLIDAR A2: ten turns a second of 360 points, clockwise. It hears stop, scan, health and the motor's speed, and
/// measures while its motor runs. A new peer finds it as the last one left it.
class RplidarServer final : public ScannerServer {
 public:
  RplidarServer(std::unique_ptr<ByteServer> wire, World world);

  void break_down() noexcept { status_ = 2; }
  /// Its turns begin at this angle, degrees, and end beyond 360.
  void begin_turns_at(double angle_deg) noexcept { first_q6_ = static_cast<unsigned>(64.0 * angle_deg); }

 private:
  void on_bytes(wire::Bytes bytes) override;
  Message message_of(std::size_t first_beam, Ranges range_m, Time began, Time now) override;
  void obey(std::uint8_t command);

  std::vector<std::uint8_t> came_in_;
  bool motor_runs_ = false;
  std::uint8_t status_ = 0;
  unsigned first_q6_ = 0;
};

/// An LMS200 with 181 beams in centimetres: sends all its values or none, as it is told. What its line takes for a
/// telegram it takes here too.
class Lms200Server final : public ScannerServer {
 public:
  Lms200Server(std::unique_ptr<ByteServer> wire, std::uint32_t baud, World world);

  /// The status in its telegrams: 0 well, 2 warning, 3 error, 4 fatal; 40h more: implausible values, 80h more: dirt.
  void set_status(std::uint8_t status) noexcept { status_ = status; }
  [[nodiscard]] bool set_window(Window window) override;

 private:
  void on_bytes(wire::Bytes bytes) override;
  Message message_of(std::size_t first_beam, Ranges range_m, Time began, Time now) override;
  [[nodiscard]] std::vector<std::uint8_t> framed(std::span<const std::uint8_t> body) const;

  std::vector<std::uint8_t> came_in_;
  std::uint8_t status_ = 0;
};

}  // namespace jaywalk::emulators
