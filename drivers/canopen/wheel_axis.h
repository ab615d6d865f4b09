#pragma once
// One wheel of a CANopen drive base.
#include <array>
#include <cstdint>
#include <string>

#include "drivers/can/can_bus.h"
#include "drivers/canopen/cia402.h"
#include "drivers/stop_ladder.h"
#include "drivers/wired_drive.h"
#include "hal/types/fixed_vector.h"
#include "hal/types/wheels.h"

namespace jaywalk::canopen {

/// When a drive that was proved counts as lost.
struct AxisLimits {
  Duration silence{0};     ///< without a heartbeat
  Duration unanswered{0};  ///< without process data, from the first SYNC that it did not answer
  Duration showing{0};     ///< from enabling until it shows its mode
};

/// State of one drive by its frames (network state, power state, mode, speed and position of its wheel), and the frame
/// that commands it. Never allocates.
class WheelAxis {
 public:
  WheelAxis() = default;
  /// `heartbeat`: period of the drive's own, 1017h.
  WheelAxis(const CanAxis& setup, Duration heartbeat) noexcept;

  /// Any frame of the bus; those that are not this drive's are passed over.
  void take(const ReceivedFrame& received) noexcept;
  /// The drive was proved: what it does from now on counts. `heard`: its heartbeat; faults that it shows until
  /// `settled` are those being reset. `heard_all`: no frame was lost since. False where its angle may not go on from
  /// before.
  bool begin(Time heard, Time settled, bool heard_all) noexcept;
  /// A SYNC was sent.
  void note_sync(Time now) noexcept;
  /// Since begin() its node number spoke more often than one drive does: a second drive has it.
  [[nodiscard]] bool has_twin() const noexcept { return has_twin_; }
  /// The drive's fault by its frames since begin(); kNone where there is none.
  [[nodiscard]] DriveTrouble trouble(Time now, const AxisLimits& limits) noexcept;
  /// Whether its heartbeat is late. Booted up anew it may have none before it is set up.
  [[nodiscard]] bool is_silent(Time now, Duration limit) const noexcept {
    return network_ != NmtState::kBootUp && heard_ != kNever && age(heard_, now) > limit;
  }
  /// Process data for one cycle. A fault that is there after begin() is reset once.
  [[nodiscard]] CanFrame target(DriveGoal goal, double wanted_radps) noexcept;
  /// The quick stop as an SDO request, which a drive takes that takes no process data (Pre-operational).
  [[nodiscard]] CanFrame quick_stop_request() const noexcept;

  [[nodiscard]] const CanAxis& setup() const noexcept { return setup_; }
  [[nodiscard]] bool is_enabled() const noexcept { return state_ == DriveState::kOperationEnabled; }
  /// Enabled, and in the mode that takes speeds. Many drives show their mode (6061h) only once enabled, and late.
  [[nodiscard]] bool follows_speeds() const noexcept { return is_enabled() && mode_ == kProfileVelocityMode; }
  /// Value of 6061h.
  [[nodiscard]] std::uint8_t mode() const noexcept { return mode_; }
  /// True by its last heartbeat.
  [[nodiscard]] bool is_operational() const noexcept { return network_ == NmtState::kOperational; }
  [[nodiscard]] const WheelFeedback& feedback() const noexcept { return feedback_; }
  [[nodiscard]] double turned_rad() const noexcept;  ///< since start, unwrapped
  /// Status and position both came since the last call of used().
  [[nodiscard]] bool is_complete() const noexcept { return fresh_status_ && fresh_position_; }
  void used() noexcept { fresh_status_ = fresh_position_ = false; }

 private:
  void take_heartbeat(NmtState state, Time stamp) noexcept;
  void take_status(const ReceivedFrame& received) noexcept;
  void take_position(const ReceivedFrame& received) noexcept;
  [[nodiscard]] DriveTrouble mode_trouble(Time now, Duration showing, bool was_enabled) noexcept;

  CanAxis setup_;
  Duration heartbeat_{};
  PdoMapping command_mapping_, status_mapping_, position_mapping_;
  // What it says.
  NmtState network_ = NmtState::kBootUp;
  DriveState state_ = DriveState::kUnknown;
  std::uint8_t mode_ = 0;
  WheelFeedback feedback_;
  std::uint32_t raw_position_ = 0;
  bool has_position_ = false;
  Time placed_ = kNever;    ///< of the last position
  bool restarted_ = false;  ///< since begin(); or its position jumped
  std::int64_t counts_ = 0;
  bool fresh_status_ = false, fresh_position_ = false;
  // What is held against it.
  Time heard_ = kNever, settled_ = kNever, unanswered_since_ = kNever;
  DriveGoal goal_ = DriveGoal::kOff;  ///< asked of it last
  bool was_enabled_ = false, resets_fault_ = false;
  Time enabled_ = kNever;     ///< since when it was seen to be
  bool showed_mode_ = false;  ///< since then
  FrameRate heartbeats_, statuses_, positions_;
  bool has_twin_ = false;
  DriveTrouble left_network_ = DriveTrouble::kNone;
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
