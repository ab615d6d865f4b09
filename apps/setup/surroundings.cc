#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "apps/setup/robot_setup.h"
#include "drivers/can/can_interface.h"
#include "drivers/can/socketcan.h"
#include "hal/types/errors.h"

namespace jaywalk {
namespace {

constexpr std::size_t kMostHosts = 16;

/// What the makers set: SICK 192.168.0.1, Hokuyo 192.168.0.10.
constexpr std::array kMakersHosts{"192.168.0.1", "192.168.0.10"};

/// What `folder` holds, sorted, of the files whose names end so; nothing where there is no folder.
std::vector<std::string> files_in(const char* folder, const std::string& ending) {
  std::vector<std::string> found;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(folder, none))
    if (entry.path().string().ends_with(ending)) found.push_back(entry.path().string());
  std::sort(found.begin(), found.end());
  return found;
}

class LockedBus final : public CanBus {
 public:
  LockedBus(const std::string& interface, Clock& clock) : lock_(interface), bus_(open_can(interface, kAll), clock) {}

  [[nodiscard]] SendResult send(const CanFrame& frame) noexcept override { return bus_.send(frame); }
  [[nodiscard]] bool receive(ReceivedFrame& received) noexcept override { return bus_.receive(received); }
  [[nodiscard]] CanHealth health() const noexcept override { return bus_.health(); }

 private:
  static constexpr std::array kAll{CanFilter{.id = 0, .mask = 0, .extended = false},
                                   CanFilter{.id = 0, .mask = 0, .extended = true}};
  BusLock lock_;
  SocketCan bus_;
};

class ThisMachine final : public Surroundings {
 public:
  explicit ThisMachine(Clock& clock) : clock_(clock) {}

  [[nodiscard]] std::vector<std::string> can_interfaces() override { return jaywalk::can_interfaces(); }
  [[nodiscard]] std::unique_ptr<CanBus> open_bus(const std::string& interface) override {
    const LinkFacts facts = link_facts(interface);
    if (!facts.is_up)
      throw StartupError(interface + (facts.exists ? ": is down" : ": no such interface"),
                         "ip link set " + interface + " up type can bitrate 500000, with the rate the drives have");
    return std::make_unique<LockedBus>(interface, clock_);
  }
  [[nodiscard]] std::vector<std::string> serial_lines() override { return files_in("/dev/serial/by-id", ""); }
  [[nodiscard]] std::vector<std::string> hosts() override {
    std::vector<std::string> hosts(kMakersHosts.begin(), kMakersHosts.end());
    std::ifstream neighbours("/proc/net/arp");
    std::string line;
    std::getline(neighbours, line);  // the columns' names
    while (std::getline(neighbours, line) && hosts.size() < kMostHosts) {
      std::string address;
      std::istringstream(line) >> address;
      if (std::find(hosts.begin(), hosts.end(), address) == hosts.end()) hosts.push_back(address);
    }
    return hosts;
  }
  [[nodiscard]] std::vector<std::string> joysticks() override {
    std::vector<std::string> found = files_in("/dev/input/by-id", "-event-joystick");
    const std::vector<std::string> by_path = files_in("/dev/input/by-path", "-event-joystick");
    return found.empty() ? by_path : found;
  }

 private:
  Clock& clock_;
};

}  // namespace

std::unique_ptr<Surroundings> this_machine(Clock& clock) { return std::make_unique<ThisMachine>(clock); }

}  // namespace jaywalk
