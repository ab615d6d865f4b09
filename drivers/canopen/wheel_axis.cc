#include "drivers/canopen/wheel_axis.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "drivers/canopen/drive_proof.h"

namespace jaywalk::canopen {
namespace {

std::int32_t to_counts(double speed_radps, double per_rad) noexcept {
  constexpr double kMost = 2147483647.0;
  const double counts = std::clamp(speed_radps * per_rad, -kMost, kMost);
  return static_cast<std::int32_t>(counts < 0.0 ? counts - 0.5 : counts + 0.5);
}

constexpr std::uint32_t kNmt = 0x000, kSync = 0x080, kLss = 0x7E5, kHeartbeat = 0x700, kSdoRequest = 0x600,
                        kSdoAnswer = 0x580;
constexpr std::array<std::uint32_t, 4> kReceivePdos{0x200, 0x300, 0x400, 0x500};

std::string kind_of(std::uint32_t id) {
  if (id == kNmt) return "NMT command";
  if (id == kSync) return "SYNC";
  if (id == kLss) return "LSS command";
  const std::string node = " node " + std::to_string(id & 0x7FU);
  const std::uint32_t base = id & ~0x7FU;
  if (base == kHeartbeat) return "heartbeat of" + node;
  if (base == kSdoRequest) return "SDO request to" + node;
  if (base == kSdoAnswer) return "SDO answer that was not asked for, of" + node;
  const bool from_drive = base == 0x180 || base == 0x280;  // of which two are too many
  return (from_drive ? "process data, too often, of" : "process data to") + node;
}

}  // namespace

WheelAxis::WheelAxis(const CanAxis& setup, Duration heartbeat, Duration showing) noexcept
    : setup_(setup),
      heartbeat_(heartbeat),
      showing_(showing),
      command_mapping_(command_pdo(setup.node).mapping),
      status_mapping_(status_pdo(setup.node).mapping),
      position_mapping_(position_pdo(setup.node).mapping) {}

AxisNews WheelAxis::take(const ReceivedFrame& received) noexcept {
  const CanFrame& frame = received.frame;
  if (frame.extended) return {};
  const auto heartbeat = decode_heartbeat(frame);
  if (heartbeat && heartbeat->node == setup_.node) return take_heartbeat(heartbeat->state, received.stamp);
  if (frame.id == 0x180U + setup_.node) return take_status(received);
  if (frame.id == 0x280U + setup_.node) return take_position(frame);
  return {};
}

AxisNews WheelAxis::take_heartbeat(NmtState state, Time stamp) noexcept {
  has_twin_ = !heartbeats_.take_at(stamp, heartbeat_) || has_twin_;
  network_ = state;
  AxisNews news{.heartbeat = true};
  if (state == NmtState::kBootUp)
    news.trouble = DriveTrouble::kDriveRestarted;
  else if (state != NmtState::kOperational)
    news.trouble = DriveTrouble::kNotOperational;
  return news;
}

AxisNews WheelAxis::take_status(const ReceivedFrame& received) noexcept {
  has_twin_ = !statuses_.take() || has_twin_;
  const auto values = unpack(status_mapping_, received.frame);
  if (!values) return {};
  state_ = state_of(static_cast<std::uint16_t>((*values)[0]));
  speed_radps_ = static_cast<double>(static_cast<std::int32_t>((*values)[1])) / setup_.per_rad;
  mode_ = static_cast<std::uint8_t>((*values)[2]);
  unanswered_since_ = kNever;
  return {.status = true, .trouble = mode_trouble(received.stamp)};
}

// The position wraps at 32 bits: the difference, as a signed number, is right across the wrap.
AxisNews WheelAxis::take_position(const CanFrame& frame) noexcept {
  has_twin_ = !positions_.take() || has_twin_;
  const auto values = unpack(position_mapping_, frame);
  if (!values) return {};
  const std::uint32_t raw = (*values)[0];
  const auto counted = static_cast<std::int32_t>(raw - std::exchange(raw_position_, raw));
  return {.turned_rad = counted / setup_.per_rad};
}

DriveTrouble WheelAxis::mode_trouble(Time stamp) noexcept {
  if (!is_enabled()) {
    enabled_ = kNever;
    showed_mode_ = false;
    return DriveTrouble::kNone;
  }
  if (enabled_ == kNever) enabled_ = stamp;
  if (!follows_speeds() && showed_mode_) return DriveTrouble::kDriveRestarted;
  showed_mode_ = follows_speeds();
  return !showed_mode_ && stamp - enabled_ > showing_ ? DriveTrouble::kNotProved : DriveTrouble::kNone;
}

void WheelAxis::begin() noexcept {
  state_ = DriveState::kUnknown;
  unanswered_since_ = enabled_ = kNever;
  showed_mode_ = false;
  heartbeats_ = statuses_ = positions_ = {};
  has_twin_ = false;
}

void WheelAxis::note_sync(Time now) noexcept {
  if (unanswered_since_ == kNever) unanswered_since_ = now;
  statuses_.expect(1.0), positions_.expect(1.0);
}

CanFrame WheelAxis::target(DriveGoal goal, double wanted_radps) noexcept {
  const std::uint16_t controlword = controlword_towards(goal, state_, resets_fault_);
  if (state_ != DriveState::kUnknown) resets_fault_ = false;
  const std::int32_t target = to_counts(wanted_radps, setup_.per_rad);
  const std::array<std::uint32_t, 2> values{controlword, static_cast<std::uint32_t>(target)};
  return pack(command_mapping_, 0x200U + setup_.node, values).value_or(CanFrame{});
}

CanFrame WheelAxis::quick_stop_request() const noexcept {
  CanFrame frame;
  frame.id = 0x600U + setup_.node;
  frame.size = 8;
  // An expedited write of two bytes to 6040h.
  frame.bytes = {0x2B, 0x40, 0x60, 0x00};
  frame.bytes[4] =
      static_cast<std::uint8_t>(controlword_towards(DriveGoal::kQuickStop, DriveState::kOperationEnabled, false));
  return frame;
}

Identifiers masters_identifiers(std::uint8_t controller_node, const std::array<std::uint8_t, 2>& drives) noexcept {
  Identifiers ids;
  bool fit =
      ids.push_back(kNmt) && ids.push_back(kSync) && ids.push_back(kLss) && ids.push_back(kHeartbeat + controller_node);
  for (const std::uint8_t node : drives) {
    for (const std::uint32_t base : kReceivePdos) fit = fit && ids.push_back(base + node);
    fit = fit && ids.push_back(kSdoRequest + node);
  }
  assert(fit);
  static_cast<void>(fit);
  return ids;
}

std::string describe_foreign(const CanFrame& frame) { return kind_of(frame.id) + " (" + to_text(frame) + ")"; }

}  // namespace jaywalk::canopen
