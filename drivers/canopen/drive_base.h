#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "drivers/can/can_bus.h"
#include "drivers/canopen/cia402.h"
#include "drivers/canopen/drive_proof.h"
#include "drivers/wired_drive.h"
#include "hal/types/wheels.h"

namespace jaywalk::canopen {

/// State of one drive by its frames (network state, power state, mode, speed and position of its wheel), and the frame
/// that commands it. Never allocates.
class WheelAxis {
 public:
  WheelAxis() = default;
  /// `heartbeat`: period of the drive's own, 1017h.
  WheelAxis(const CanAxis& setup, Duration heartbeat) noexcept : setup_(setup), heartbeat_(heartbeat) {}

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
  /// The drive's fault by its frames since begin(); kNone where there is none. It counts as lost `silence` after its
  /// last heartbeat, and `unanswered` after the first SYNC that it answered with no process data.
  [[nodiscard]] DriveTrouble trouble(Time now, Duration silence, Duration unanswered) noexcept;
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
  [[nodiscard]] DriveTrouble mode_trouble(Time now, bool was_enabled) noexcept;

  CanAxis setup_;
  Duration heartbeat_{};
  // What it says.
  NmtState network_ = NmtState::kBootUp;
  DriveState state_ = DriveState::kUnknown;
  std::uint8_t mode_ = 0;
  WheelFeedback feedback_;
  std::optional<std::uint32_t> raw_position_;
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

using Identifiers = std::array<std::uint32_t, 14>;

/// NMT commands, SYNC, LSS; the heartbeat under the controller's node; RPDOs 1 to 4 and SDO requests of both drives.
[[nodiscard]] Identifiers masters_identifiers(std::uint8_t controller_node,
                                              const std::array<std::uint8_t, 2>& drives) noexcept;

/// "heartbeat with the controller's node (701#05)". Not for the loop.
[[nodiscard]] std::string describe_foreign(const CanFrame& frame);

struct DriveBaseSetup {
  std::array<CanAxis, 2> axes;  ///< left, right: counts a radian of the wheel
  DriveSettings settings;
  StopLimits stop;
  Duration silence_limit = std::chrono::milliseconds(150);  ///< a drive that says no heartbeat for so long is lost
  bool allow_unproved = false;  ///< arms although a drive did not prove that it stops by itself
};

/// Two CiA 402 axes as one drive base in profile velocity.
///
/// `latest` takes in what came, `command` sends the controller's heartbeat, both targets and SYNC: so the heartbeat is
/// the tick's, and a dead loop is a silent one, for which the drives were proved to stop by themselves. At any trouble
/// both drives are quick-stopped, and the stop is held against the wheels' feedback: where that does not confirm it,
/// they are NMT-stopped, and then nothing is sent at all until reset(), so that their own watchdogs act (SAFETY 14).
///
/// While both drives are proved they have no torque and no heartbeat, and there is no trouble. Thread: one.
class CanopenDriveBase final : public WiredDrive {
 public:
  /// `bus` and `clock` outlive it. Throws StartupError where the setup cannot be.
  CanopenDriveBase(CanBus& bus, Clock& clock, const DriveBaseSetup& setup);

  /// Listens for another master, sets up and proves both drives, then starts their process data.
  std::vector<std::string> arm() override;
  [[nodiscard]] std::string inspect(std::size_t side) override;

  [[nodiscard]] WheelState latest() noexcept override;
  /// A speed that is not finite counts as trouble on the controller's side: zero is sent instead.
  void command(const WheelCommand& command) noexcept override;

  [[nodiscard]] DriveTrouble trouble() const noexcept override { return trouble_; }
  [[nodiscard]] bool is_proved() const noexcept override {
    return phase_ == Phase::kProved && trouble_ == DriveTrouble::kNone;
  }
  [[nodiscard]] std::optional<CanFrame> foreign_frame() const noexcept override { return foreign_; }
  [[nodiscard]] bool is_silent() const noexcept override {
    return axes_[0].is_silent(clock_.now(), setup_.silence_limit) ||
           axes_[1].is_silent(clock_.now(), setup_.silence_limit);
  }
  void reset() noexcept override;
  [[nodiscard]] bool is_enabled() const noexcept override;
  /// Wheels that still turn are braked first.
  void disarm() noexcept override;

 private:
  enum class Phase : std::uint8_t { kUnproved, kListening, kProving, kProved };

  [[nodiscard]] Time now() const noexcept { return clock_.now(); }
  /// Lets a proof of the caller's run to its end.
  void conduct(ArmingProof& proof);
  [[noreturn]] void refuse() const;

  void begin_proof() noexcept;
  void follow_proof() noexcept;
  void begin_operation() noexcept;
  [[nodiscard]] bool is_proving() const noexcept { return phase_ == Phase::kListening || phase_ == Phase::kProving; }

  void take(const ReceivedFrame& received) noexcept;
  [[nodiscard]] bool is_foreign(const ReceivedFrame& received) const noexcept;
  /// A frame of another master's, or of a second drive with a number of ours.
  void note_foreign(const CanFrame& frame) noexcept;
  void publish(Time stamp) noexcept;
  void watch() noexcept;
  void latch(DriveTrouble trouble) noexcept;
  /// Keeps the first fault that a drive reports; later ones follow from it.
  void note(const DriveFault& fault) noexcept {
    if (!fault_.is_told()) fault_ = fault;
  }

  /// A cycle on the bus, as far as the stop has come.
  void cycle(DriveGoal goal, bool stopping, const std::array<double, 2>& speeds_radps) noexcept;
  void send_targets(DriveGoal goal, const std::array<double, 2>& speeds_radps) noexcept;
  void send(const CanFrame& frame) noexcept {
    if (!bus_.send(frame)) latch(DriveTrouble::kBusRefused);
  }
  [[nodiscard]] bool are_at_rest() const noexcept;
  /// Both drives are enabled and show the mode that takes speeds.
  [[nodiscard]] bool follow_speeds() const noexcept {
    return is_enabled() && axes_[0].follows_speeds() && axes_[1].follows_speeds();
  }

  CanBus& bus_;
  Clock& clock_;
  DriveBaseSetup setup_;
  std::array<WheelAxis, 2> axes_;
  std::array<DriveProof, 2> proofs_;
  Identifiers masters_;
  StopLadder ladder_;
  WheelState wheels_;
  bool counts_on_ = true;          ///< both angles, since the last reading
  std::uint64_t frames_lost_ = 0;  ///< when its operation began last
  DriveTrouble trouble_ = DriveTrouble::kNone;
  DriveFault fault_;
  std::optional<CanFrame> foreign_;
  Phase phase_ = Phase::kUnproved;
  Time began_ = kNever;  ///< this phase
  bool awaits_zero_ = true;
  BusWatch bus_watch_;
};

}  // namespace jaywalk::canopen
