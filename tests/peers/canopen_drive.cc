// The emulated CiA 402 drive as a program, for a CANopen master of others: a frame a line, "601 40181001" (identifier
// and bytes in hexadecimal), in on standard input and out on standard output. Ends with its input.
#include <poll.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "hil/emulators/cia402_node.h"

namespace {

using namespace jaywalk;

/// A bus on which the rest of the world is a pipe.
class PipeBus final : public CanBus {
 public:
  [[nodiscard]] bool send(const CanFrame& frame) noexcept override {
    std::printf("%03X ", static_cast<unsigned>(frame.id));
    for (std::uint8_t k = 0; k < frame.size; ++k) std::printf("%02X", static_cast<unsigned>(frame.bytes[k]));
    std::printf("\n");
    std::fflush(stdout);
    return true;
  }
  [[nodiscard]] bool receive(ReceivedFrame& received) noexcept override {
    const std::size_t end = came_in_.find('\n');
    if (end == std::string::npos) return false;
    const std::string line = came_in_.substr(0, end);
    came_in_.erase(0, end + 1);
    char* rest = nullptr;
    received.frame = {};
    received.frame.id = static_cast<std::uint32_t>(std::strtoul(line.c_str(), &rest, 16));
    for (std::size_t at = line.find(' ') + 1; at + 1 < line.size() && received.frame.size < 8; at += 2) {
      received.frame.bytes[received.frame.size++] =
          static_cast<std::uint8_t>(std::strtoul(line.substr(at, 2).c_str(), nullptr, 16));
    }
    return true;
  }
  [[nodiscard]] CanHealth health() const noexcept override { return {}; }

  /// Waits a millisecond at most for what comes; false at the end of it.
  bool wait() {
    pollfd in{STDIN_FILENO, POLLIN, 0};
    if (::poll(&in, 1, 1) <= 0) return true;
    char bytes[1024];
    const ssize_t count = ::read(STDIN_FILENO, bytes, sizeof bytes);
    if (count > 0) came_in_.append(bytes, static_cast<std::size_t>(count));
    return count > 0;
  }

 private:
  std::string came_in_;
};

}  // namespace

int main(int argc, char** argv) {
  const int node = argc == 2 ? std::atoi(argv[1]) : 0;
  if (node < 1 || node > 127) return std::fputs("usage: jaywalk_peer_canopen_drive NODE (1 to 127)\n", stderr), 2;
  PipeBus bus;
  emulators::Cia402Node drive(bus, static_cast<std::uint8_t>(node));
  const auto began = std::chrono::steady_clock::now();
  do {
    drive.step(Time{std::chrono::steady_clock::now() - began});
  } while (bus.wait());
  return 0;
}
