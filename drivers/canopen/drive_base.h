#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "drivers/can/can_bus.h"
#include "drivers/canopen/drive_proof.h"
#include "drivers/canopen/wheel_axis.h"
#include "drivers/wired_drive.h"

namespace jaywalk::canopen {

struct DriveBaseSetup {
  std::array<CanAxis, 2> axes;  ///< left, right: counts a radian of the wheel
  DriveSettings settings;
  StopLimits stop;
  Duration listening = std::chrono::milliseconds(300);       ///< for another master, before anything is sent
  Duration answer_timeout = std::chrono::milliseconds(100);  ///< of one transfer while arming
  Duration starting = std::chrono::milliseconds(500);        ///< from NMT start until a drive says it is operational
  Duration silence_limit = std::chrono::milliseconds(150);   ///< a drive that says no heartbeat for so long is lost
  Duration settling = std::chrono::milliseconds(200);        ///< what a drive may take to leave a fault after a reset
  Duration showing = std::chrono::milliseconds(500);         ///< from enabling until a drive shows its mode (6061h)
  bool allow_unproved = false;  ///< arms although a drive did not prove that it stops by itself
};

/// Two CiA 402 axes as one drive base in profile velocity.
///
/// `latest` takes in what came, `command` sends the controller's heartbeat, both targets and SYNC: so the heartbeat is
/// the tick's, and a dead loop is a silent one, for which the drives were proved to stop by themselves. At any trouble
/// both drives are quick-stopped, and the stop is held against the wheels' feedback: where that does not confirm it,
/// they are NMT-stopped, and then nothing is sent at all until reset(), so that their own watchdogs act (SAFETY 14).
///
/// The wheels turn only after the whole proof of both drives and a command of zero. arm() waits for that proof; after a
/// trouble reset() begins it anew, and it goes on with every latest() and command(). Meanwhile the drives have no
/// torque and no heartbeat, and there is no trouble. Thread: one.
class CanopenDriveBase final : public WiredDrive {
 public:
  /// `bus` and `clock` outlive it. Throws StartupError where the setup cannot be.
  CanopenDriveBase(CanBus& bus, Clock& clock, const DriveBaseSetup& setup);

  /// Start-up only, waits up to some seconds: listens for another master, sets up and proves both drives, then starts
  /// their process data. Throws StartupError that names the first thing not proved, unless allow_unproved.
  /// Returns what each drive said, one line a setting, for the record.
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
  /// A person's reset edge: forgets the trouble and, where there was one, begins the proof of both drives; the drives
  /// are enabled again at the next command of zero after it. A proof that is under way goes on.
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

  [[nodiscard]] Time now() noexcept { return clock_.now(); }
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
  void note(const DriveFault& fault) noexcept;

  /// A cycle on the bus, as far as the stop has come.
  void cycle(DriveGoal goal, bool stopping, double left_radps, double right_radps) noexcept;
  void send_targets(DriveGoal goal, double left_radps, double right_radps) noexcept;
  void send(const CanFrame& frame) noexcept;
  [[nodiscard]] bool are_at_rest() const noexcept;
  /// Both drives are enabled and show the mode that takes speeds.
  [[nodiscard]] bool follow_speeds() const noexcept;

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
