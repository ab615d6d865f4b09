#include "drivers/canopen/drive_base.h"
#include "drivers/canopen/drive_proof.h"
#include "drivers/wire/byte_reader.h"

namespace jaywalk::canopen {
namespace {

constexpr std::uint32_t kNmt = 0x000, kSync = 0x080, kLss = 0x7E5, kHeartbeat = 0x700, kSdoRequest = 0x600,
                        kSdoAnswer = 0x580;
constexpr Duration kShowing = std::chrono::milliseconds(500);  ///< from enabling until a drive shows its mode (6061h)

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

void WheelAxis::take(const ReceivedFrame& received) noexcept {
  const CanFrame& frame = received.frame;
  if (frame.extended) return;
  if (const auto network = heartbeat_in(frame, setup_.node)) take_heartbeat(*network, received.stamp);
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
  wire::ByteReader reader(received.frame.payload());
  const auto statusword = reader.little<std::uint16_t>();
  const auto counts = static_cast<std::int32_t>(reader.little<std::uint32_t>());
  const auto mode = reader.little<std::uint8_t>();
  if (received.frame.remote || !reader.ok()) return;
  state_ = state_of(statusword);
  feedback_ = {counts / setup_.per_rad, received.stamp};
  mode_ = mode;
  fresh_status_ = true;
  unanswered_since_ = kNever;
}

// The position wraps at 32 bits: the difference, as a signed number, is right across the wrap.
void WheelAxis::take_position(const ReceivedFrame& received) noexcept {
  has_twin_ = !positions_.take() || has_twin_;
  wire::ByteReader reader(received.frame.payload());
  const auto raw = reader.little<std::uint32_t>();
  if (received.frame.remote || !reader.ok()) return;
  const auto counted = static_cast<std::int32_t>(raw - raw_position_.value_or(raw));
  if (jumps(counted / setup_.per_rad, feedback_.speed_radps, to_seconds(age(placed_, received.stamp)))) {
    restarted_ = true;
    left_network_ = DriveTrouble::kDriveRestarted;
  } else {
    counts_ += counted;
  }
  raw_position_ = raw;
  placed_ = received.stamp;
  fresh_position_ = true;
}

double WheelAxis::turned_rad() const noexcept { return static_cast<double>(counts_) / setup_.per_rad; }

// A drive that restarted, or may have, counts from where it likes: its position goes on from the next that comes.
bool WheelAxis::begin(Time heard, Time settled, bool heard_all) noexcept {
  const bool counts_on = raw_position_ && heard_all && !restarted_;
  heard_ = heard;
  settled_ = settled;
  unanswered_since_ = kNever;
  state_ = DriveState::kUnknown;
  feedback_ = {};
  if (!counts_on) raw_position_.reset();
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

DriveTrouble WheelAxis::trouble(Time now, Duration silence, Duration unanswered) noexcept {
  if (left_network_ != DriveTrouble::kNone) return left_network_;
  if (age(heard_, now) > silence) return DriveTrouble::kDriveSilent;
  if (unanswered_since_ != kNever && now - unanswered_since_ > unanswered) return DriveTrouble::kDriveSilent;
  const bool in_fault = state_ == DriveState::kFault || state_ == DriveState::kFaultReactionActive;
  if (in_fault && now > settled_) return DriveTrouble::kDriveFault;
  const bool was_enabled = was_enabled_ && goal_ == DriveGoal::kEnabled;  // it may leave operation where it is asked to
  was_enabled_ = is_enabled();
  if (!is_enabled()) return was_enabled ? DriveTrouble::kLeftOperation : DriveTrouble::kNone;
  return mode_trouble(now, was_enabled);
}

DriveTrouble WheelAxis::mode_trouble(Time now, bool was_enabled) noexcept {
  if (!was_enabled) {
    enabled_ = now;
    showed_mode_ = false;
  }
  if (follows_speeds()) {
    showed_mode_ = true;
    return DriveTrouble::kNone;
  }
  if (showed_mode_) return DriveTrouble::kDriveRestarted;
  return now - enabled_ > kShowing ? DriveTrouble::kNotProved : DriveTrouble::kNone;
}

CanFrame WheelAxis::target(DriveGoal goal, double wanted_radps) noexcept {
  const std::uint16_t controlword = controlword_towards(goal, state_, resets_fault_);
  if (state_ != DriveState::kUnknown) resets_fault_ = false;
  goal_ = goal;
  return command_frame(setup_.node, controlword, rounded_within(wanted_radps * setup_.per_rad, 2147483647.0));
}

CanFrame WheelAxis::quick_stop_request() const noexcept {
  // An expedited write of two bytes, 0002h, to 6040h.
  return {.id = kSdoRequest + setup_.node, .size = 8, .bytes = {0x2B, 0x40, 0x60, 0x00, 0x02}};
}

Identifiers masters_identifiers(std::uint8_t controller_node, const std::array<std::uint8_t, 2>& drives) noexcept {
  Identifiers ids{kNmt, kSync, kLss, kHeartbeat + controller_node};
  auto* next = ids.begin() + 4;
  for (const std::uint8_t node : drives)
    for (const std::uint32_t base : {0x200U, 0x300U, 0x400U, 0x500U, kSdoRequest}) *next++ = base + node;
  return ids;
}

std::string describe_foreign(const CanFrame& frame) { return kind_of(frame.id) + " (" + to_text(frame) + ")"; }

}  // namespace jaywalk::canopen
