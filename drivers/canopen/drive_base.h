#pragma once
// Two CiA 402 drives as a drive base: what each says, its proof, and the frames that command both.
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "drivers/can/can_bus.h"
#include "drivers/canopen/cia402.h"
#include "drivers/canopen/drive_proof.h"
#include "drivers/motor/motor_pair.h"
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

struct DriveBaseSetup {
  std::array<CanAxis, 2> axes;  ///< left, right: counts a radian of the wheel
  DriveSettings settings;
  StopLimits stop;
  Duration answer_timeout = std::chrono::milliseconds(100);  ///< of one transfer while arming
  Duration starting = std::chrono::milliseconds(500);        ///< from NMT start until a drive says it is operational
  Duration silence_limit = std::chrono::milliseconds(150);   ///< a drive that says no heartbeat for so long is lost
  Duration settling = std::chrono::milliseconds(200);        ///< what a drive may take to leave a fault after a reset
  Duration showing = std::chrono::milliseconds(500);         ///< from enabling until a drive shows its mode (6061h)
  bool allow_unproved = false;  ///< arms although a drive did not prove that it stops by itself
};

/// Two CiA 402 axes in profile velocity.
///
/// A cycle is the controller's heartbeat, both targets and SYNC: so the heartbeat is the tick's, and a dead loop is a
/// silent one, for which the drives were proved to stop by themselves. At any trouble both drives are quick-stopped. A
/// wheel whose feedback does not confirm that has its drive NMT-stopped, and no heartbeat is sent any more, so that
/// both drives' own watchdogs act (SAFETY 14).
///
/// Arming proof: DriveProof of both drives at once, after a time of listening. Meanwhile they have no torque and no
/// heartbeat.
class CanopenDriveBase final : public MotorPair {
 public:
  /// `bus` and `clock` outlive it. Throws StartupError where the setup cannot be.
  CanopenDriveBase(CanBus& bus, Clock& clock, const DriveBaseSetup& setup);
  [[nodiscard]] std::string inspect(std::size_t side) override;
  /// What drives say that are to be proved anew tells of what was.
  void reset() noexcept override {
    MotorPair::reset();
    fed_ = fed_ && is_proved();
  }
  [[nodiscard]] bool is_enabled() const noexcept override { return axes_[0].is_enabled() && axes_[1].is_enabled(); }

 private:
  /// Lets a proof of the caller's run to its end.
  void conduct(ArmingProof& proof);
  void take(const ReceivedFrame& received) noexcept override;
  void take_axis(std::size_t index, const ReceivedFrame& received) noexcept;
  [[nodiscard]] bool is_foreign(const ReceivedFrame& received) const noexcept;
  void begin_cycle() noexcept override;
  void send_order(std::size_t index, MotorOrder order, double speed_radps) noexcept override;
  void end_cycle() noexcept override;
  void send_reset(std::size_t index) noexcept override { axes_[index].reset_fault(); }
  /// It says nothing before it is set up.
  [[nodiscard]] bool shows_itself(std::size_t) const noexcept override { return true; }
  void watch_motor(std::size_t index) noexcept override;
  void begin_proof(std::size_t index) noexcept override;
  ProofResult continue_proof(std::size_t index) noexcept override;
  [[nodiscard]] std::vector<std::string> proof_report(std::size_t index) const override;
  [[nodiscard]] std::string proof_line(std::size_t index) const override { return proofs_[index].failure(); }
  [[nodiscard]] std::string proof_remedy(std::size_t index) const override { return proofs_[index].remedy(); }
  [[nodiscard]] StartupError absence(std::size_t index) const override;
  [[nodiscard]] StartupError refusal(const CanFrame& foreign) const override;

  CanBus& bus_;
  DriveBaseSetup setup_;
  std::array<WheelAxis, 2> axes_;
  std::array<DriveProof, 2> proofs_;
  Identifiers masters_;
  bool fed_ = false;       ///< proved: it gets heartbeats
  bool commands_ = false;  ///< a drive was told something in this cycle
  bool asks_ = false;      ///< the proof is past listening
  Time listens_since_ = kNever, asked_ = kNever;
};

}  // namespace jaywalk::canopen
