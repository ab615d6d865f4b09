// The emulated Hokuyo as a program, for a driver of others: it stands in a round room of 3 m radius with a post of
// 30 degrees at 1 m to its left. Prints its port; ends with its standard input.
#include <poll.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>

#include "hil/emulators/scanners.h"

int main() {
  using namespace jaywalk;
  constexpr double kPost_rad = 1.5707963267948966, kHalfPost_rad = 0.2617993877991494;
  auto wire = std::make_unique<emulators::TcpServer>(0);
  std::printf("%d\n", static_cast<int>(wire->port()));
  std::fflush(stdout);
  emulators::SweepShape shape;
  emulators::ScipServer scanner(std::move(wire), {}, [&shape](std::size_t first, std::span<float> range_m) {
    for (std::size_t k = 0; k < range_m.size(); ++k)
      range_m[k] = std::fabs(shape.angle_rad(first + k) - kPost_rad) < kHalfPost_rad ? 1.0F : 3.0F;
  });
  shape = scanner.shape();
  const auto began = std::chrono::steady_clock::now();
  for (pollfd in{STDIN_FILENO, POLLIN, 0}; ::poll(&in, 1, 1) == 0;)
    scanner.step(Time{std::chrono::steady_clock::now() - began});
  return 0;
}
