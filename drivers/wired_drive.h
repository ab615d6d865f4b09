#pragma once
#include <optional>
#include <string>
#include <vector>

#include "drivers/can/can_frame.h"
#include "hal/hal.h"

namespace jaywalk {

/// A drive base at the end of a wire: what the loop sees of it is a DriveBase; what surrounds the loop sees this.
///
/// At any trouble the wheels are stopped; they move again only after reset() and a command of zero. That holds at
/// start too. Thread: the loop's, or the one that arms and disarms while no loop runs.
class WiredDrive : public DriveBase {
 public:
  /// Start-up only, may wait up to some seconds: sets the drives up and has each prove that it stops by itself.
  /// Returns what each said, a line a setting, for the record. Throws StartupError that names what was not proved.
  virtual std::vector<std::string> arm() = 0;
  /// Start-up only, in place of arm(): asks the drive on side 0 (left) or 1 what it is and how it is set. Changes
  /// nothing, no wheel gets torque. Returns what it said; throws StartupError where it could not be armed so.
  [[nodiscard]] virtual std::string inspect(std::size_t side) = 0;
  /// Also in latest().trouble.
  [[nodiscard]] virtual DriveTrouble trouble() const noexcept = 0;
  /// Whether a drive that was heard says nothing now, whatever the trouble: a loose plug, no power.
  [[nodiscard]] virtual bool is_silent() const noexcept { return false; }
  /// A person's reset edge, while the wheels stand: forgets the trouble. Where there was one, both drives are proved
  /// anew, whole, before they get torque; that goes on with latest() and command() until is_proved() or the next
  /// trouble.
  virtual void reset() noexcept = 0;
  /// Both drives passed the whole proof since they last restarted, dropped out or changed state by themselves.
  [[nodiscard]] virtual bool is_proved() const noexcept = 0;
  /// The frame of another master that is the trouble; nothing where there was none.
  [[nodiscard]] virtual std::optional<CanFrame> foreign_frame() const noexcept { return std::nullopt; }
  /// Both wheels follow commands.
  [[nodiscard]] virtual bool is_enabled() const noexcept = 0;
  /// Takes the torque away, at rest: after the last command. To be called again and again until !is_enabled().
  virtual void disarm() noexcept = 0;
};

/// A second way to the same wheels, for a thread that has nothing to do with the loop's.
class EmergencyBrake {
 public:
  virtual ~EmergencyBrake() = default;
  /// Tells the drives to stop as fast as they were set to; does not wait.
  virtual void brake() noexcept = 0;
};

}  // namespace jaywalk
