// The service's sandbox lets the planner open the GPUs of a PC and of a Jetson, and the joystick and scanners it had.
#include <fnmatch.h>

#include <algorithm>
#include <fstream>
#include <string>
#include <vector>

#include "tests/support/catch.h"

namespace {

/// Patterns of DeviceAllow: names as in /proc/devices, or paths.
std::vector<std::string> permitted_devices() {
  std::ifstream unit(std::string(JAYWALK_EXAMPLES) + "/../systemd/jaywalk.service");
  std::vector<std::string> patterns;
  for (std::string line; std::getline(unit, line);) {
    const std::string key = "DeviceAllow=";
    if (line.starts_with(key)) patterns.push_back(line.substr(key.size(), line.find(' ') - key.size()));
  }
  return patterns;
}

}  // namespace

TEST_CASE("the service may open the devices of GPUs, serial scanners and joysticks") {
  const std::vector<std::string> patterns = permitted_devices();
  REQUIRE(patterns.size() > 5);
  // /proc/devices of drivers 470 to 570 on a PC, and of JetPack 6 on an Orin; nvmap there is of "misc", by its path.
  for (const char* name :
       {"char-nvidia-frontend", "char-nvidia", "char-nvidiactl", "char-nvidia-uvm", "char-nvidia-caps",
        "char-nvidia-modeset", "char-nvhost-ctrl-gpu", "char-nvhost", "char-nvgpu", "char-nvgpu-ctrl", "char-host1x",
        "char-drm", "/dev/nvmap", "/dev/host1x-fence", "/dev/cpu_dma_latency", "char-ttyUSB", "char-ttyACM",
        "char-ttyTHS", "char-input"}) {
    CAPTURE(name);
    CHECK(std::ranges::any_of(patterns, [name](const std::string& p) { return fnmatch(p.c_str(), name, 0) == 0; }));
  }
  for (const char* name : {"char-mem", "char-misc", "block-sd", "/dev/kvm"}) {
    CAPTURE(name);
    CHECK(std::ranges::none_of(patterns, [name](const std::string& p) { return fnmatch(p.c_str(), name, 0) == 0; }));
  }
}
