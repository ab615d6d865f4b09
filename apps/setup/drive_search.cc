#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "apps/setup/robot_setup.h"
#include "drivers/arcos/arcos_base.h"
#include "drivers/can/can_bus.h"
#include "drivers/canopen/sdo_client.h"
#include "drivers/motor/odrive.h"
#include "drivers/motor/vesc.h"
#include "drivers/wire/byte_reader.h"
#include "hal/shown_text.h"

namespace jaywalk {
namespace {

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
  /// Both messages of an axis: one alone may be some other device's.
  [[nodiscard]] std::set<std::uint8_t> whole_odrives() const {
    std::set<std::uint8_t> both = odrives;
    std::erase_if(both, [this](std::uint8_t node) { return !odrive_estimates.contains(node); });
    return both;
  }
};

std::vector<FoundNode> named(const std::set<std::uint8_t>& nodes, const char* said) {
  std::vector<FoundNode> found;
  for (const std::uint8_t node : nodes) found.push_back({node, said});
  return found;
}

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
  std::map<std::uint8_t, std::string> identity;
  constexpr std::array kParts{"vendor", "product", "revision", "serial number"};
  for (std::uint8_t sub = 1; sub <= kParts.size(); ++sub) {
    for (const auto& [node, value] : ask(bus, clock, drives, {0x1018, sub})) {
      identity[node] +=
          formatted("%s%s %08Xh", identity[node].empty() ? "" : ", ", kParts[sub - 1U], static_cast<unsigned>(value));
    }
  }
  for (const std::uint8_t node : drives)
    found.nodes.push_back({node, identity[node].empty() ? "no identity (1018h)" : identity[node]});
  return found;
}

}  // namespace

FoundDrives find_drives(CanBus& bus, Clock& clock) {
  Voices voices;
  for (const Time until = clock.now() + kListen; clock.now() < until;) {
    clock.sleep_until(clock.now() + kStep);
    ReceivedFrame received;
    while (bus.receive(received)) voices.take(received.frame);
  }
  const std::vector<FoundNode> odrives = named(voices.whole_odrives(), "heartbeat and encoder estimates heard");
  const std::vector<FoundNode> vescs = named(voices.vescs, "status messages heard");
  if (odrives.empty() && vescs.empty()) return ask_canopen(bus, clock);
  if (vescs.empty()) return {DriveKind::kOdrive, odrives, ""};
  std::vector<std::string> others;
  for (const FoundNode& node : odrives) others.push_back(std::to_string(int{node.node}));
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
