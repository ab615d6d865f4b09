#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "drivers/can/can_bus.h"
#include "drivers/canopen/cia402.h"
#include "drivers/canopen/drive_settings.h"
#include "drivers/wired_drive.h"

namespace jaywalk::canopen {

/// One wheel's drive. Its velocity counts are counts a second, its position counts are counts.
struct AxisSetup {
  std::uint8_t node = 0;
  double counts_per_rad = 0.0;  ///< of the wheel; negative where the motor is mounted the other way round
};

struct DriveBaseSetup {
  std::array<AxisSetup, 2> axes;  ///< left, right
  DriveSettings settings;
  Duration answer_timeout = std::chrono::milliseconds(100);  ///< of one transfer while arming
  Duration silence_limit = std::chrono::milliseconds(150);   ///< a drive that says no heartbeat for so long is lost
  Duration settling = std::chrono::milliseconds(200);        ///< what a drive may take to leave a fault after a reset
  bool allow_unproved = false;  ///< arms although a drive did not prove that it stops by itself
};

/// Two CiA 402 axes as one drive base in profile velocity.
///
/// `latest` takes in what came, `command` sends the controller's heartbeat, both targets and SYNC: so the heartbeat is
/// the tick's, and a dead loop is a silent one, for which the drives were proved to stop by themselves. At any trouble
/// both drives are quick-stopped; they move again only after reset() and a command of zero. That holds at start too.
/// Thread: one.
class CanopenDriveBase final : public WiredDrive {
 public:
  /// `bus` and `clock` outlive it. Throws StartupError where the setup cannot be.
  CanopenDriveBase(CanBus& bus, Clock& clock, const DriveBaseSetup& setup);

  /// Start-up only, waits up to some seconds: sets up and proves both drives, then starts their process data.
  /// Throws StartupError that names the first thing not proved, unless allow_unproved.
  /// Returns what each drive said, one line a setting, for the record.
  std::vector<std::string> arm() override;
  [[nodiscard]] std::string inspect(std::size_t side) override;

  [[nodiscard]] WheelState latest() noexcept override;
  /// A speed that is not finite counts as trouble on the controller's side: zero is sent instead.
  void command(const WheelCommand& command) noexcept override;

  [[nodiscard]] DriveTrouble trouble() const noexcept override { return trouble_; }
  /// A person's reset edge: forgets the trouble; the drives are enabled again at the next command of zero.
  void reset() noexcept override;
  [[nodiscard]] bool is_enabled() const noexcept override;
  [[nodiscard]] bool is_proved() const noexcept override { return armed_; }
  void disarm() noexcept override;

 private:
  struct Axis {
    AxisSetup setup;
    PdoMapping command_mapping, status_mapping, position_mapping;
    DriveState state = DriveState::kUnknown;
    bool was_enabled = false;
    double speed_radps = 0.0;
    std::uint32_t raw_position = 0;
    bool has_position = false;
    std::int64_t counts = 0;  ///< since arming, unwrapped
    bool fresh_status = false, fresh_position = false;
    Time heard = kNever;
  };

  /// Lets a proof run to its end.
  void conduct(ArmingProof& proof);
  void prove(Axis& axis, std::vector<std::string>& report);
  void take(const ReceivedFrame& received) noexcept;
  void take_status(Axis& axis, const CanFrame& frame) noexcept;
  void take_position(Axis& axis, const CanFrame& frame) noexcept;
  void publish(Time stamp) noexcept;
  void watch() noexcept;
  void latch(DriveTrouble trouble) noexcept;
  void send(const CanFrame& frame) noexcept;
  void send_cycle(DriveGoal goal, double left_radps, double right_radps) noexcept;
  void send_target(Axis& axis, DriveGoal goal, double wanted_radps) noexcept;

  CanBus& bus_;
  Clock& clock_;
  DriveBaseSetup setup_;
  std::array<Axis, 2> axes_;
  WheelState wheels_;
  DriveTrouble trouble_ = DriveTrouble::kNone;
  bool armed_ = false;
  bool awaits_zero_ = true;
  bool reset_pulse_ = false;
  BusWatch bus_watch_;
  Time settled_ = kNever;  ///< faults that a drive still shows before this are those being reset
};

}  // namespace jaywalk::canopen
