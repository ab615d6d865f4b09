#include <algorithm>
#include <cassert>

#include "drivers/canopen/drive_base.h"
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

WheelAxis::WheelAxis(const CanAxis& setup, Duration heartbeat) noexcept
    : setup_(setup),
      heartbeat_(heartbeat),
      command_mapping_(command_pdo(setup.node).mapping),
      status_mapping_(status_pdo(setup.node).mapping),
      position_mapping_(position_pdo(setup.node).mapping) {}

void WheelAxis::take(const ReceivedFrame& received) noexcept {
  const CanFrame& frame = received.frame;
  if (frame.extended) return;
  const auto heartbeat = decode_heartbeat(frame);
  if (heartbeat && heartbeat->node == setup_.node) take_heartbeat(heartbeat->state, received.stamp);
  if (frame.id == 0x180U + setup_.node) take_status(received);
  if (frame.id == 0x280U + setup_.node) take_position(received);
}

// A boot-up may be followed by "operational" at once, from a drive that starts itself: it is kept.
void WheelAxis::take_heartbeat(NmtState state, Time stamp) noexcept {
  has_twin_ = !heartbeats_.take_at(stamp, heartbeat_) || has_twin_;
  network_ = state;
  heard_ = stamp;
  restarted_ = restarted_ || state == NmtState::kBootUp;
  if (state == NmtState::kOperational) return;
  if (left_network_ != DriveTrouble::kDriveRestarted)
    left_network_ = state == NmtState::kBootUp ? DriveTrouble::kDriveRestarted : DriveTrouble::kNotOperational;
}

void WheelAxis::take_status(const ReceivedFrame& received) noexcept {
  has_twin_ = !statuses_.take() || has_twin_;
  const auto values = unpack(status_mapping_, received.frame);
  if (!values) return;
  state_ = state_of(static_cast<std::uint16_t>((*values)[0]));
  const auto counts = static_cast<double>(static_cast<std::int32_t>((*values)[1]));
  feedback_ = {counts / setup_.per_rad, received.stamp};
  mode_ = static_cast<std::uint8_t>((*values)[2]);
  fresh_status_ = true;
  unanswered_since_ = kNever;
}

// The position wraps at 32 bits: the difference, as a signed number, is right across the wrap.
void WheelAxis::take_position(const ReceivedFrame& received) noexcept {
  has_twin_ = !positions_.take() || has_twin_;
  const auto values = unpack(position_mapping_, received.frame);
  if (!values) return;
  const std::uint32_t raw = (*values)[0];
  const std::int32_t counted = has_position_ ? static_cast<std::int32_t>(raw - raw_position_) : 0;
  if (jumps(counted / setup_.per_rad, feedback_.speed_radps, to_seconds(age(placed_, received.stamp)))) {
    restarted_ = true;
    left_network_ = DriveTrouble::kDriveRestarted;
  } else {
    counts_ += counted;
  }
  raw_position_ = raw;
  placed_ = received.stamp;
  has_position_ = true;
  fresh_position_ = true;
}

double WheelAxis::turned_rad() const noexcept { return static_cast<double>(counts_) / setup_.per_rad; }

// A drive that restarted, or may have, counts from where it likes: its position goes on from the next that comes.
bool WheelAxis::begin(Time heard, Time settled, bool heard_all) noexcept {
  const bool counts_on = has_position_ && heard_all && !restarted_;
  heard_ = heard;
  settled_ = settled;
  unanswered_since_ = kNever;
  state_ = DriveState::kUnknown;
  feedback_ = {};
  has_position_ = counts_on;
  fresh_status_ = fresh_position_ = was_enabled_ = restarted_ = false;
  resets_fault_ = true;
  left_network_ = DriveTrouble::kNone;
  heartbeats_ = statuses_ = positions_ = {};
  has_twin_ = false;
  return counts_on;
}

void WheelAxis::note_sync(Time now) noexcept {
  if (unanswered_since_ == kNever) unanswered_since_ = now;
  statuses_.expect(1.0), positions_.expect(1.0);
}

DriveTrouble WheelAxis::trouble(Time now, const AxisLimits& limits) noexcept {
  if (left_network_ != DriveTrouble::kNone) return left_network_;
  if (age(heard_, now) > limits.silence) return DriveTrouble::kDriveSilent;
  if (unanswered_since_ != kNever && now - unanswered_since_ > limits.unanswered) return DriveTrouble::kDriveSilent;
  const bool in_fault = state_ == DriveState::kFault || state_ == DriveState::kFaultReactionActive;
  if (in_fault && now > settled_) return DriveTrouble::kDriveFault;
  const bool was_enabled = was_enabled_ && goal_ == DriveGoal::kEnabled;  // it may leave operation where it is asked to
  was_enabled_ = is_enabled();
  if (!is_enabled()) return was_enabled ? DriveTrouble::kLeftOperation : DriveTrouble::kNone;
  return mode_trouble(now, limits.showing, was_enabled);
}

DriveTrouble WheelAxis::mode_trouble(Time now, Duration showing, bool was_enabled) noexcept {
  if (!was_enabled) {
    enabled_ = now;
    showed_mode_ = false;
  }
  if (follows_speeds()) {
    showed_mode_ = true;
    return DriveTrouble::kNone;
  }
  if (showed_mode_) return DriveTrouble::kDriveRestarted;
  return now - enabled_ > showing ? DriveTrouble::kNotProved : DriveTrouble::kNone;
}

CanFrame WheelAxis::target(DriveGoal goal, double wanted_radps) noexcept {
  const std::uint16_t controlword = controlword_towards(goal, state_, resets_fault_);
  if (state_ != DriveState::kUnknown) resets_fault_ = false;
  goal_ = goal;
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
