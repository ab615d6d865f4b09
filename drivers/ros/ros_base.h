#pragma once
// A ROS 2 robot's base and laser, through jaywalk_dds.
#include <array>
#include <string>

#include "drivers/can/can_bus.h"
#include "drivers/laser/scanner_protocol.h"
#include "drivers/motor/motor_pair.h"
#include "drivers/ros/shared_ring.h"
#include "drivers/wire/byte_link.h"
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

  [[nodiscard]] SendResult send(const CanFrame& frame) noexcept override;
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
/// often as the robot file states; no other node commands the base; and commanded zero it stands. That the base
/// stops by itself when no commands come (its cmd_vel timeout) would show only while it drives: never proved, so
/// that arming needs allow_unproved. jaywalk_dds commands zero 100 ms after the loop's last command; the base's timeout
/// is for the death of both. A base has no second way to stop but silence.
class RosBase final : public MotorPair {
 public:
  /// `bus` and `clock` outlive it. Throws StartupError where the setup cannot be.
  RosBase(CanBus& bus, Clock& clock, const BaseSetup& setup);

 private:
  void take(const ReceivedFrame& received) noexcept override;
  void send_order(std::size_t index, MotorOrder order, double speed_radps) noexcept override;
  void send_reset(std::size_t) noexcept override {}
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

/// Has jaywalk_dds stop the base.
class Stopper final : public EmergencyBrake {
 public:
  explicit Stopper(RosBus& bus) noexcept : bus_(bus) {}
  void brake() noexcept override { bus_.brake(); }

 private:
  RosBus& bus_;
};

/// Fills `scan`, all but its sequence, from a message that came in by `arrival`. Nothing in it is believed: kMalformed
/// for another size, angles, limits or times that no scanner has. An infinite range is free where `infinity_is_free`
/// (REP 117), else unknown, as all that is no number or not above zero.
[[nodiscard]] Heard decode_scan(wire::Bytes message, Time arrival, bool infinity_is_free, LaserScan& scan) noexcept;

/// Scans of a ROS topic: nothing is said, each message is whole.
class RosScanProtocol final : public ScannerProtocol {
 public:
  explicit RosScanProtocol(bool infinity_is_free) noexcept : infinity_is_free_(infinity_is_free) {}
  void begin() noexcept override { heard_ = 0; }
  [[nodiscard]] wire::Bytes to_say(Time) noexcept override { return {}; }
  [[nodiscard]] bool awaits_answer() const noexcept override { return false; }
  void hear(wire::Bytes bytes) noexcept override;
  [[nodiscard]] Heard next(Time arrival, LaserScan& scan) noexcept override;
  [[nodiscard]] ProtocolCounts counts() const noexcept override { return {}; }

 private:
  bool infinity_is_free_;
  std::size_t heard_ = 0;  ///< bytes of the message; 0: none
  std::array<std::uint8_t, kScanRing.message_bytes> message_{};
};

/// The scans that jaywalk_dds puts into a shared ring, as a link that brings one whole message at a time; a torn one is
/// a single byte. It is open at once: scans that do not come are a silent scanner.
class RingLink final : public wire::Link {
 public:
  /// Makes the ring. `name`: the topic. Throws StartupError.
  RingLink(const std::filesystem::path& ring, std::string name)
      : ring_(SharedRing::make(ring, kScanRing)), name_(std::move(name)) {}

  [[nodiscard]] const std::string& name() const noexcept override { return name_; }
  void open() noexcept override;
  void close() noexcept override { state_ = State::kClosed; }
  [[nodiscard]] State state() noexcept override { return state_; }
  [[nodiscard]] wire::Bytes read(std::span<std::uint8_t> room) noexcept override;
  void write(wire::Bytes) noexcept override {}
  void wait(Duration most) noexcept override;

 private:
  std::unique_ptr<SharedRing> ring_;
  std::string name_;
  State state_ = State::kClosed;
  std::array<std::uint8_t, kScanRing.message_bytes> message_{};
};

}  // namespace jaywalk::ros
