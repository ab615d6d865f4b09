#include <array>
#include <map>
#include <memory>
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
      const bool own = std::holds_alternative<vesc::Status>(message->content) ||
                       std::holds_alternative<vesc::Travel>(message->content);
      if (own) vescs.insert(message->controller);
    }
  }
  /// Both messages of an axis: one alone may be some other device's.
  [[nodiscard]] std::set<std::uint8_t> whole_odrives() const {
    std::set<std::uint8_t> both;
    for (const std::uint8_t node : odrives)
      if (odrive_estimates.count(node) != 0) both.insert(node);
    return both;
  }
};

std::vector<FoundNode> named(const std::set<std::uint8_t>& nodes, const char* said) {
  std::vector<FoundNode> found;
  for (const std::uint8_t node : nodes) found.push_back({node, said});
  return found;
}

std::string listed(const std::vector<FoundNode>& nodes) {
  std::string words;
  for (const FoundNode& node : nodes) words += (words.empty() ? "" : ", ") + std::to_string(int{node.node});
  return words;
}

/// Asks many nodes at once, each one object at a time.
class NodeQuestions {
 public:
  NodeQuestions(CanBus& bus, Clock& clock) : bus_(bus), clock_(clock) {
    for (std::uint8_t node = 1; node <= kLastNode; ++node)
      clients_[node] = std::make_unique<canopen::SdoClient>(bus, node, kAnswerLimit);
  }
  /// What each of `nodes` answers; none where it does not, or has no such object.
  std::map<std::uint8_t, std::uint32_t> ask(const std::set<std::uint8_t>& nodes, canopen::ObjectAddress address) {
    for (const std::uint8_t node : nodes) {
      static_cast<void>(clients_[node]->read(address, clock_.now()));
      pass(kStep);
    }
    for (const Time until = clock_.now() + kAnswerLimit + kStep; clock_.now() < until;) pass(kStep);
    std::map<std::uint8_t, std::uint32_t> answers;
    for (const std::uint8_t node : nodes) {
      const canopen::SdoClient& client = *clients_[node];
      if (client.status() != canopen::SdoStatus::kDone || client.value().size() > 4) continue;
      std::array<std::uint8_t, 4> bytes{};
      std::copy(client.value().begin(), client.value().end(), bytes.begin());
      answers[node] = wire::little_endian<std::uint32_t>(bytes);
    }
    return answers;
  }

 private:
  void pass(Duration time) {
    clock_.sleep_until(clock_.now() + time);
    const Time now = clock_.now();
    ReceivedFrame received;
    while (bus_.receive(received))
      for (auto& [node, client] : clients_) client->on_frame(received.frame, now);
    for (auto& [node, client] : clients_) client->poll(now);
  }

  CanBus& bus_;
  Clock& clock_;
  std::map<std::uint8_t, std::unique_ptr<canopen::SdoClient>> clients_;
};

FoundDrives ask_canopen(CanBus& bus, Clock& clock) {
  NodeQuestions questions(bus, clock);
  std::set<std::uint8_t> all, drives;
  for (std::uint8_t node = 1; node <= kLastNode; ++node) all.insert(node);
  FoundDrives found;
  for (const auto& [node, type] : questions.ask(all, {0x1000, 0})) {
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
    for (const auto& [node, value] : questions.ask(drives, {0x1018, sub})) {
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
  return {DriveKind::kVesc, vescs, odrives.empty() ? "" : "ODrives are there as well: " + listed(odrives)};
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
