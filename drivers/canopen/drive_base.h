#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "drivers/can/can_bus.h"
#include "drivers/canopen/drive_proof.h"
#include "drivers/canopen/wheel_axis.h"
#include "drivers/motor/motor_pair.h"

namespace jaywalk::canopen {

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
