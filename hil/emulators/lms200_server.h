#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "hil/emulators/scanner_server.h"

namespace jaywalk::emulators {

/// An LMS200 with 181 beams in centimetres: sends all its values or none, as it is told. What its line takes for a
/// telegram it takes here too.
class Lms200Server final : public ScannerServer {
 public:
  Lms200Server(std::unique_ptr<ByteServer> wire, std::uint32_t baud, World world);

  /// The status in its telegrams: 0 well, 2 warning, 3 error, 4 fatal; 40h more: implausible values, 80h more: dirt.
  void set_status(std::uint8_t status) noexcept { status_ = status; }
  [[nodiscard]] bool set_window(Window window) override;

 private:
  void on_new_peer() override {}
  void on_bytes(wire::Bytes bytes) override;
  std::vector<std::uint8_t> message_of(std::size_t first_beam, std::span<const float> range_m, Time began,
                                       Time now) override;
  [[nodiscard]] std::vector<std::uint8_t> framed(std::span<const std::uint8_t> body) const;

  std::vector<std::uint8_t> came_in_;
  std::uint8_t status_ = 0;
};

}  // namespace jaywalk::emulators
