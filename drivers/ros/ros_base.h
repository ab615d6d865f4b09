#pragma once
// A ROS 2 robot as a drive base, through jaywalk_dds.

#include <array>
#include <string>

#include "drivers/can/can_bus.h"
#include "drivers/motor/motor_pair.h"
#include "drivers/ros/shared_ring.h"
#include "hal/hal.h"

namespace jaywalk::ros {

/// A ROS base as a bus with two motors: frames to and from jaywalk_dds through a shared ring each way. Frames that are
/// torn, unknown or of another time are counted as malformed. Thread: one, and any for brake().
class RosBus final : public CanBus {
 public:
  struct Rings {
    std::filesystem::path states, orders;
  };
  /// Makes both rings. `clock` outlives it. Throws StartupError.
  RosBus(const Rings& rings, Clock& clock)
      : states_(SharedRing::make(rings.states, kBaseRing)),
        orders_(SharedRing::make(rings.orders, kBaseRing)),
        clock_(clock) {}

  [[nodiscard]] bool send(const CanFrame& frame) noexcept override;
  [[nodiscard]] bool receive(ReceivedFrame& received) noexcept override;
  [[nodiscard]] CanHealth health() const noexcept override;
  /// Has jaywalk_dds command zero at once.
  void brake() noexcept { orders_->raise_alarm(); }

 private:
  std::unique_ptr<SharedRing> states_, orders_;
  Clock& clock_;
  std::uint64_t malformed_ = 0;
};

struct BaseSetup {
  std::string odometry = "/odom", command = "/cmd_vel";  ///< topics
  bool stamped = false;                                  ///< the command is a TwistStamped
  bool reliable = false;                                 ///< odometry is asked for again where it is lost
  StopLimits stop;                                       ///< braking and tolerance must be given
  bool allow_unproved = false;
  Duration tick = std::chrono::milliseconds(20);
  DriveTimes times{};  ///< of its odometry
};

/// A base that obeys cmd_vel and publishes its odometry on ROS 2, as two motors behind jaywalk_dds.
///
/// Arming proof, before the first command and after every return: some node listens to the commands; odometry comes as
/// often as the robot file states; no other node commands the base; and commanded zero it stands. The base's own
/// timeout (cmd_vel timeout) would show only while it drives: never proved, so that arming needs allow_unproved.
/// jaywalk_dds commands zero 100 ms after the loop's last command; the base's timeout is for the death of both.
class RosBase final : public MotorPair {
 public:
  /// `bus` and `clock` outlive it. Throws StartupError where the setup cannot be.
  RosBase(CanBus& bus, Clock& clock, const BaseSetup& setup);

 private:
  void take(const ReceivedFrame& received) noexcept override;
  void send_order(std::size_t index, MotorOrder order, double speed_radps) noexcept override;
  void begin_proof(std::size_t index) noexcept override;
  ProofResult continue_proof(std::size_t index) noexcept override;
  [[nodiscard]] std::string proof_line(std::size_t index) const override;
  [[nodiscard]] std::string proof_remedy(std::size_t index) const override;
  [[nodiscard]] StartupError absence(std::size_t index) const override;

  BaseSetup setup_;
  std::array<ShownReports, 2> shown_;
  std::array<int, 2> listened_{};  ///< nodes, in its proof
  std::array<std::uint32_t, 2> angles_{};
  std::array<bool, 2> torque_on_{};
  int listeners_ = 0;
  Time zero_sent_ = kNever;
};

}  // namespace jaywalk::ros
