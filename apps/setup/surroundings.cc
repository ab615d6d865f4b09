#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <set>
#include <sstream>

#include "apps/setup/robot_setup.h"
#include "drivers/arcos/arcos_base.h"
#include "drivers/can/socketcan.h"
#include "drivers/canopen/sdo_client.h"
#include "drivers/laser/scanner_connection.h"
#include "drivers/motor/odrive.h"
#include "drivers/motor/vesc.h"
#include "drivers/wire/byte_reader.h"
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

std::unique_ptr<CanBus> open_locked(const std::string& interface, Clock& clock) {
  const LinkFacts facts = link_facts(interface);
  if (!facts.is_up)
    throw StartupError(interface + (facts.exists ? ": is down" : ": no such interface"),
                       "ip link set " + interface + " up type can bitrate 500000, with the rate the drives have");
  return std::make_unique<LockedBus>(interface, clock);
}

std::vector<std::string> known_hosts() {
  std::vector<std::string> hosts(kMakersHosts.begin(), kMakersHosts.end());
  std::ifstream neighbours("/proc/net/arp");
  std::string line;
  std::getline(neighbours, line);  // the columns' names
  while (std::getline(neighbours, line) && hosts.size() < kMostHosts) {
    std::string address;
    std::istringstream(line) >> address;
    if (std::ranges::count(hosts, address) == 0) hosts.push_back(address);
  }
  return hosts;
}

std::vector<std::string> joystick_files() {
  const std::vector<std::string> found = files_in("/dev/input/by-id", "-event-joystick");
  return found.empty() ? files_in("/dev/input/by-path", "-event-joystick") : found;
}

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

constexpr Duration kListen = std::chrono::seconds(1);  ///< ODrives and VESCs speak ten times a second at least
constexpr Duration kAnswerLimit = std::chrono::milliseconds(300);
constexpr Duration kStep = std::chrono::milliseconds(2);  ///< two frames fit into it at 125 kbit/s
constexpr int kPulses = 2;                                ///< to a Pioneer, at each rate
constexpr std::uint8_t kLastNode = 127;
constexpr std::uint32_t kDriveProfile = 402;

/// Nodes that spoke without being asked.
struct Voices {
  std::set<std::uint8_t> odrives, odrive_estimates, vescs;

  void take(const CanFrame& frame) {
    if (const auto message = odrive::decode(frame)) {
      if (std::holds_alternative<odrive::Heartbeat>(message->content)) odrives.insert(message->node);
      if (std::holds_alternative<odrive::EncoderEstimates>(message->content)) odrive_estimates.insert(message->node);
    }
    if (const auto message = vesc::decode(frame)) {
      const auto& content = message->content;
      if (std::holds_alternative<vesc::Status>(content) || std::holds_alternative<vesc::Travel>(content))
        vescs.insert(message->controller);
    }
  }
};

/// Asks all of `nodes` at once. What each answers; none where it does not, or has no such object.
std::map<std::uint8_t, std::uint32_t> ask(CanBus& bus, Clock& clock, const std::set<std::uint8_t>& nodes,
                                          canopen::ObjectAddress address) {
  std::map<std::uint8_t, canopen::SdoClient> clients;
  const auto pass = [&](Duration time) {
    clock.sleep_until(clock.now() + time);
    const Time now = clock.now();
    ReceivedFrame received;
    while (bus.receive(received))
      for (auto& [node, client] : clients) client.on_frame(received.frame, now);
    for (auto& [node, client] : clients) client.poll(now);
  };
  for (const std::uint8_t node : nodes) {
    static_cast<void>(clients.try_emplace(node, bus, node, kAnswerLimit).first->second.read(address, clock.now()));
    pass(kStep);
  }
  for (const Time until = clock.now() + kAnswerLimit + kStep; clock.now() < until;) pass(kStep);
  std::map<std::uint8_t, std::uint32_t> answers;
  for (const auto& [node, client] : clients) {
    if (client.status() != canopen::SdoStatus::kDone || client.value().size() > 4) continue;
    std::array<std::uint8_t, 4> bytes{};
    std::ranges::copy(client.value(), bytes.begin());
    answers[node] = wire::little_endian<std::uint32_t>(bytes);
  }
  return answers;
}

FoundDrives ask_canopen(CanBus& bus, Clock& clock) {
  std::set<std::uint8_t> all, drives;
  for (std::uint8_t node = 1; node <= kLastNode; ++node) all.insert(node);
  FoundDrives found;
  for (const auto& [node, type] : ask(bus, clock, all, {0x1000, 0})) {
    if ((type & 0xFFFFU) == kDriveProfile) {
      drives.insert(node);
    } else {
      found.remark += (found.remark.empty() ? "" : "; ") + ("CANopen node " + std::to_string(int{node})) +
                      " is no CiA 402 drive, by its 1000h";
    }
  }
  if (drives.empty()) return found;
  found.kind = DriveKind::kCia402;
  constexpr std::array kParts{"vendor", "product", "revision", "serial number"};
  for (std::uint8_t sub = 1; sub <= kParts.size(); ++sub) {
    for (const auto& [node, value] : ask(bus, clock, drives, {0x1018, sub})) {
      std::string& said = found.nodes[node];
      said += formatted("%s%s %08Xh", said.empty() ? "" : ", ", kParts[sub - 1U], static_cast<unsigned>(value));
    }
  }
  for (const std::uint8_t node : drives) found.nodes.try_emplace(node, "no identity (1018h)");
  return found;
}

}  // namespace

Surroundings this_machine(Clock& clock) {
  return {.can_interfaces = can_interfaces,
          .serial_lines = [] { return files_in("/dev/serial/by-id", ""); },
          .hosts = known_hosts,
          .joysticks = joystick_files,
          .open_bus = [&clock](const std::string& interface) { return open_locked(interface, clock); }};
}

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

FoundDrives find_drives(CanBus& bus, Clock& clock) {
  Voices voices;
  for (const Time until = clock.now() + kListen; clock.now() < until;) {
    clock.sleep_until(clock.now() + kStep);
    ReceivedFrame received;
    while (bus.receive(received)) voices.take(received.frame);
  }
  FoundNodes odrives, vescs;
  std::vector<std::string> others;
  for (const std::uint8_t node : voices.odrives) {  // both messages of an axis: one alone may be some other device's
    if (!voices.odrive_estimates.contains(node)) continue;
    odrives[node] = "heartbeat and encoder estimates heard";
    others.push_back(std::to_string(int{node}));
  }
  for (const std::uint8_t node : voices.vescs) vescs[node] = "status messages heard";
  if (odrives.empty() && vescs.empty()) return ask_canopen(bus, clock);
  if (vescs.empty()) return {DriveKind::kOdrive, odrives, ""};
  return {DriveKind::kVesc, vescs, others.empty() ? "" : "ODrives are there as well: " + joined(others)};
}

std::optional<std::uint32_t> find_pioneer(const std::string& device, Clock& clock) {
  for (const std::uint32_t baud : {9600U, 115200U, 57600U, 38400U, 19200U}) {  // the factory's first
    ByteBus line(wire::make_byte_link("", 0, device, baud), clock);
    arcos::PacketReader reader;
    const arcos::Packet pulse = arcos::packet_of({arcos::Command::kPulse});
    for (int k = 0; k < kPulses; ++k) {
      in_frames(pulse.on_line(), [&line](const CanFrame& frame) { static_cast<void>(line.send(frame)); });
      clock.sleep_until(clock.now() + kAnswerLimit);
      ReceivedFrame received;
      while (line.receive(received)) reader.append(received.frame.payload());
      if (!reader.next().empty()) return baud;
    }
  }
  return {};
}

}  // namespace jaywalk
