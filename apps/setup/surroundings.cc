#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>

#include "apps/setup/robot_setup.h"
#include "drivers/can/can_interface.h"
#include "drivers/can/socketcan.h"
#include "drivers/laser/scanner_connection.h"
#include "hal/shown_text.h"
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

  [[nodiscard]] bool send(const CanFrame& frame) noexcept override { return bus_.send(frame); }
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

constexpr Duration kPatience = std::chrono::seconds(3), kReplyStep = std::chrono::milliseconds(1);
constexpr std::size_t kPeriodsForRate = 10;

/// One conversation, and the times between its scans.
class Trial {
 public:
  Trial(const ScannerPlace& place, ScannerKind kind, Clock& clock) {
    const ScannerMake& make = scanner_make(kind);
    static_cast<ByteWiring&>(wiring_) = place.at;
    wiring_.kind = kind;
    if (wiring_.port == 0) wiring_.port = make.port;
    if (wiring_.baud == 0) wiring_.baud = make.baud;
    connection_ = make_scanner({.kind = kind,
                                .host = wiring_.host,
                                .port = wiring_.port,
                                .device = wiring_.device,
                                .baud = wiring_.baud,
                                .range_min_m = 0.05F,
                                .range_max_m = 25.0F},
                               clock);
  }
  void look() {
    connection_->step();
    const LaserScan& scan = connection_->latest();
    if (scan.sequence == 0 || scan.sequence == last_sequence_) return;
    if (last_ != kNever) periods_.push_back((scan.stamp - last_) / (scan.sequence - last_sequence_));
    last_ = scan.stamp;
    last_sequence_ = scan.sequence;
  }
  [[nodiscard]] bool is_known() const { return periods_.size() >= kPeriodsForRate; }
  [[nodiscard]] bool has_scans() const { return !periods_.empty(); }
  [[nodiscard]] FoundScanner found() {
    const LaserScan& scan = connection_->latest();
    constexpr double kDegPerRad = 180.0 / kPi;
    const double fov_deg = std::fabs(static_cast<double>(scan.angle_step_rad)) * (scan.beam_count - 1.0) * kDegPerRad;
    return {wiring_, scan.beam_count, fov_deg, rate_hz()};
  }

 private:
  /// Of the middle period; a whole number where it is one but for the stamps' scatter.
  [[nodiscard]] double rate_hz() {
    const auto middle = periods_.begin() + static_cast<std::ptrdiff_t>(periods_.size() / 2);
    std::nth_element(periods_.begin(), middle, periods_.end());
    const double rate = 1.0 / to_seconds(*middle), whole = std::round(rate);
    return std::fabs(rate - whole) < 0.03 * whole ? whole : std::round(10.0 * rate) / 10.0;
  }

  LaserWiring wiring_;
  std::unique_ptr<ScannerConnection> connection_;
  std::vector<Duration> periods_;  ///< from a scan's stamp to the next one's
  Time last_ = kNever;
  std::uint32_t last_sequence_ = 0;
};

std::unique_ptr<Trial> try_kind(const ScannerPlace& place, std::size_t round, Clock& clock) {
  if (round >= place.kinds.size()) return nullptr;
  try {
    return std::make_unique<Trial>(place, place.kinds[round], clock);
  } catch (const StartupError&) {  // no such host, or a baud rate that the line cannot take
    return nullptr;
  }
}

void listen(std::vector<std::unique_ptr<Trial>>& trials, Clock& clock) {
  const auto is_settled = [](const std::unique_ptr<Trial>& trial) { return !trial || trial->is_known(); };
  for (const Time until = clock.now() + kPatience; clock.now() < until;) {
    clock.sleep_until(clock.now() + kReplyStep);
    for (const auto& trial : trials)
      if (trial) trial->look();
    if (std::all_of(trials.begin(), trials.end(), is_settled)) return;
  }
}

}  // namespace

std::unique_ptr<Surroundings> this_machine(Clock& clock) { return std::make_unique<ThisMachine>(clock); }

std::vector<FoundScanner> find_scanners(const std::vector<ScannerPlace>& places, Clock& clock) {
  std::vector<std::optional<FoundScanner>> by_place(places.size());
  std::size_t rounds = 0;
  for (const ScannerPlace& place : places) rounds = std::max(rounds, place.kinds.size());
  for (std::size_t round = 0; round < rounds; ++round) {
    std::vector<std::unique_ptr<Trial>> trials(places.size());
    for (std::size_t k = 0; k < places.size(); ++k)
      if (!by_place[k]) trials[k] = try_kind(places[k], round, clock);
    listen(trials, clock);
    for (std::size_t k = 0; k < places.size(); ++k)
      if (trials[k] && trials[k]->has_scans()) by_place[k] = trials[k]->found();
  }
  std::vector<FoundScanner> found;
  for (const auto& scanner : by_place)
    if (scanner) found.push_back(*scanner);
  return found;
}

std::string describe(const FoundScanner& scanner) {
  const std::string figures = formatted(": %u beams over %.2f degrees, %g a second",
                                        static_cast<unsigned>(scanner.beams), scanner.fov_deg, scanner.rate_hz);
  return std::string(scanner_make(scanner.wiring.kind).name) + " at " + name_of(scanner.wiring) + figures;
}

}  // namespace jaywalk
