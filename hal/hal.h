#pragma once
// Devices of the machine, as the control loop sees them. Each hands out the newest thing it has, at once: nothing here
// waits, allocates or throws. Thread: the loop's; devices that have one of their own publish through hal/mailbox.h.
#include "hal/types/laser_scan.h"
#include "hal/types/operator_input.h"
#include "hal/types/outside_fix.h"
#include "hal/types/time.h"
#include "hal/types/wheels.h"

namespace jaywalk {

class LaserScanner {
 public:
  virtual ~LaserScanner() = default;
  /// The newest scan; sequence 0 before the first. Valid until the next call.
  [[nodiscard]] virtual const LaserScan& latest() noexcept = 0;
};

class DriveBase {
 public:
  virtual ~DriveBase() = default;
  [[nodiscard]] virtual WheelState latest() noexcept = 0;
  /// Takes effect at once; holds until the next command or until the drive's own watchdog stops it.
  virtual void command(const WheelCommand& command) noexcept = 0;
};

class OperatorPanel {
 public:
  virtual ~OperatorPanel() = default;
  [[nodiscard]] virtual OperatorInput latest() noexcept = 0;
};

class PoseSource {
 public:
  virtual ~PoseSource() = default;
  /// The newest outside fix; sequence 0 where there is no such system. Valid until the next call.
  [[nodiscard]] virtual const OutsideFix& latest() noexcept = 0;
};

class Clock {
 public:
  virtual ~Clock() = default;
  [[nodiscard]] virtual Time now() noexcept = 0;
  /// Returns at `wake` or later; at once when it has passed. A simulated clock moves its world on.
  virtual void sleep_until(Time wake) noexcept = 0;
};

/// The bundle that the loop is given; the devices outlive it.
struct Hal {
  LaserScanner& laser;
  DriveBase& drive;
  OperatorPanel& panel;
  PoseSource& pose_source;
  Clock& clock;
  OfOthers<LaserScanner*> other_lasers{};  ///< beside `laser`, in the order of the robot's model
};

}  // namespace jaywalk
