#pragma once
#include <cstdint>

#include "hil/emulators/scanner_server.h"

namespace jaywalk::emulators {

/// An LD19: ten turns a second, clockwise, 38 packets of 12 points a turn, to every listener. It obeys nothing.
class LdServer final : public ScannerServer {
 public:
  LdServer(std::unique_ptr<ByteServer> wire, World world);

 private:
  void on_new_peer() override { set_streaming(true); }
  void on_bytes(wire::Bytes) override {}
  std::vector<std::uint8_t> message_of(std::size_t first_beam, std::span<const float> range_m, Time began,
                                       Time now) override;
};

}  // namespace jaywalk::emulators
