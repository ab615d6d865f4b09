#pragma once
// One wheel's drive on a CANopen bus: what it says, and the frame that commands it.
#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "drivers/can/can_bus.h"
#include "drivers/canopen/cia402.h"
#include "drivers/wired_drive.h"
#include "hal/types/fixed_vector.h"
#include "hal/types/wheels.h"

namespace jaywalk::canopen {

/// What one frame told of a drive.
struct AxisNews {
  bool heartbeat = false, status = false;
  std::optional<double> turned_rad = {};       ///< of its wheel, since the position before
  DriveTrouble trouble = DriveTrouble::kNone;  ///< of network state or mode; kNotProved: not in the mode in time
};

/// State of one drive by its frames: network state, power state, mode, speed and position of its wheel. Never
/// allocates.
class WheelAxis {
 public:
  /// `heartbeat`: period of the drive's own, 1017h. `showing`: most from enabling until it shows its mode.
  WheelAxis(const CanAxis& setup, Duration heartbeat, Duration showing) noexcept;

  /// Any frame of the bus; those that are not this drive's are passed over.
  AxisNews take(const ReceivedFrame& received) noexcept;
  /// The drive was proved: what it does from now on counts.
  void begin() noexcept;
  /// A SYNC was sent.
  void note_sync(Time now) noexcept;
  /// Has a fault reset with the next command: once, after a person's reset.
  void reset_fault() noexcept { resets_fault_ = true; }
  /// Since begin() its node number spoke more often than one drive does: a second drive has it.
  [[nodiscard]] bool has_twin() const noexcept { return has_twin_; }
  /// Longer than `limit` since the first SYNC that it did not answer.
  [[nodiscard]] bool is_unanswered(Time now, Duration limit) const noexcept {
    return unanswered_since_ != kNever && now - unanswered_since_ > limit;
  }
  /// Process data for one cycle.
  [[nodiscard]] CanFrame target(DriveGoal goal, double wanted_radps) noexcept;
  /// The quick stop as an SDO request, which a drive takes that takes no process data (Pre-operational).
  [[nodiscard]] CanFrame quick_stop_request() const noexcept;

  [[nodiscard]] std::uint8_t node() const noexcept { return setup_.node; }
  [[nodiscard]] bool is_enabled() const noexcept { return state_ == DriveState::kOperationEnabled; }
  [[nodiscard]] bool in_fault() const noexcept {
    return state_ == DriveState::kFault || state_ == DriveState::kFaultReactionActive;
  }
  /// Enabled, and in the mode that takes speeds. Many drives show their mode (6061h) only once enabled, and late.
  [[nodiscard]] bool follows_speeds() const noexcept { return is_enabled() && mode_ == kProfileVelocityMode; }
  /// Value of 6061h.
  [[nodiscard]] std::uint8_t mode() const noexcept { return mode_; }
  /// True by its last heartbeat.
  [[nodiscard]] bool is_operational() const noexcept { return network_ == NmtState::kOperational; }
  [[nodiscard]] double speed_radps() const noexcept { return speed_radps_; }

 private:
  [[nodiscard]] AxisNews take_heartbeat(NmtState state, Time stamp) noexcept;
  [[nodiscard]] AxisNews take_status(const ReceivedFrame& received) noexcept;
  [[nodiscard]] AxisNews take_position(const CanFrame& frame) noexcept;
  [[nodiscard]] DriveTrouble mode_trouble(Time stamp) noexcept;

  CanAxis setup_;
  Duration heartbeat_, showing_;
  PdoMapping command_mapping_, status_mapping_, position_mapping_;
  NmtState network_ = NmtState::kBootUp;
  DriveState state_ = DriveState::kUnknown;
  std::uint8_t mode_ = 0;
  double speed_radps_ = 0.0;
  std::uint32_t raw_position_ = 0;
  Time unanswered_since_ = kNever;
  Time enabled_ = kNever;     ///< since when it was seen to be
  bool showed_mode_ = false;  ///< since then
  bool resets_fault_ = false;
  FrameRate heartbeats_, statuses_, positions_;
  bool has_twin_ = false;
};

// Frames on the drives' bus that only a master sends (CiA 301). Own frames do not come back (can_bus.h): one that comes
// in was sent by another program or machine.

using Identifiers = FixedVector<std::uint32_t, 16>;

/// NMT commands, SYNC, LSS; the heartbeat under the controller's node; RPDOs 1 to 4 and SDO requests of both drives.
[[nodiscard]] Identifiers masters_identifiers(std::uint8_t controller_node,
                                              const std::array<std::uint8_t, 2>& drives) noexcept;

/// "heartbeat with the controller's node (701#05)". Not for the loop.
[[nodiscard]] std::string describe_foreign(const CanFrame& frame);

}  // namespace jaywalk::canopen
