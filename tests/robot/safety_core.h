#pragma once
// What stands between a wish and a wheel, with everything else left away: panel, reset gate, supervisor, a drive base
// and two emulated drives, time moved on by hand. It holds the rules against every tick.
#include <array>
#include <sstream>
#include <string>

#include "drivers/can/in_process_bus.h"
#include "firmware/robot/reset_gate.h"
#include "firmware/safety/supervisor.h"
#include "planner/motion/diff_drive.h"
#include "tests/drivers/drive_plant.h"
#include "tests/drivers/watched_port.h"

namespace jaywalk::tests {

class SafetyCore {
 public:
  SafetyCore() : base_(port_, clock_, two_axes()) {
    clock_.plant = [this](Time now) { left_.step(now), right_.step(now); };
    static_cast<void>(base_.arm());
    ticks(20);
  }

  // What may happen.
  void give_goal() { panel_.input.has_goal = supervisor_.mode() != Mode::kLatched; }  // the desk refuses it else
  void drop_goal() { panel_.input.has_goal = false; }
  void press_stop() { panel_.input.emergency_stop = true; }
  void release_stop() { panel_.input.emergency_stop = false; }
  void press_reset() {
    reset_pressed_ = true;
    panel_.input.reset = true;
    tick();
    panel_.input.reset = false;
  }
  void lose_scans() { scans_come_ = false; }
  void find_scans() { scans_come_ = true; }
  void tell_network(std::uint8_t command) {
    CanFrame frame;
    frame.size = 2;
    frame.bytes = {command, 0};
    static_cast<void>(bus_.port(3).send(frame));
  }
  void cut_power() { right_.restart(); }
  void pull_cable() { right_.pull_cable(), plugged_ = false; }
  void plug_cable() { right_.plug_cable(), plugged_ = true; }
  void hang_drive() { left_.hang(), hangs_ = true; }
  void break_drive() { left_.raise_fault(0x2310); }
  void ticks(int count) {
    for (int k = 0; k < count; ++k) tick();
  }

  /// What tells one state from another; continuous quantities are left to the rules.
  [[nodiscard]] std::string state() const {
    std::ostringstream out;
    out << row_of(supervisor_.mode()).name << ' ' << name(wheels_.trouble) << ' ' << name(wheels_.stop) << ' '
        << base_.is_proved() << base_.is_enabled() << ' ' << left_.state_name() << ' ' << right_.state_name() << ' '
        << (left_.velocity() != 0.0) << (right_.velocity() != 0.0) << ' ' << panel_.input.has_goal
        << panel_.input.emergency_stop << scans_come_ << plugged_ << hangs_ << reset_pressed_ << proof_owed_;
    return out.str();
  }
  /// The first rule that was broken; empty: none.
  [[nodiscard]] const std::string& broken() const noexcept { return broken_; }
  [[nodiscard]] Mode mode() const noexcept { return supervisor_.mode(); }

 private:
  struct Panel final : OperatorPanel {
    [[nodiscard]] OperatorInput latest() noexcept override { return input; }
    OperatorInput input;
  };

  static RobotModel model() {
    RobotModel model = p3dx();
    model.limits.brake_mps2 = two_axes().stop.brake_radps2 * model.drive.wheel_radius_m;
    model.laser.beams = 91;
    return model;
  }
  static SupervisorConfig config() { return {.model = model(), .latches_all = true}; }

  void look() {
    if (!scans_come_ || clock_.now() - scan_.stamp < std::chrono::milliseconds(60)) return;
    scan_.stamp = clock_.now();
    ++scan_.sequence;
    scan_.beam_count = model().laser.beams;
    scan_.first_angle_rad = static_cast<float>(-0.5 * model().laser.fov_rad);
    scan_.angle_step_rad = static_cast<float>(model().laser.fov_rad / (scan_.beam_count - 1.0));
    scan_.range_min_m = 0.05F;
    scan_.range_max_m = 25.0F;
    scan_.range_m.fill(20.0F + 0.001F * static_cast<float>(scan_.sequence % 100));
  }
  [[nodiscard]] Twist2 wish(const OperatorInput& input) const {
    constexpr double kStep_mps = 0.01, kFastest_mps = 0.4;
    const bool goes = input.has_goal && supervisor_.takes_wishes();
    return {goes ? std::min(permitted_.v_mps + kStep_mps, kFastest_mps) : std::max(permitted_.v_mps - kStep_mps, 0.0),
            0.0};
  }
  void tick() {
    clock_.sleep_until(clock_.now() + std::chrono::milliseconds(20));
    look();
    wheels_ = base_.latest();
    const OperatorInput input = gate_.latest();
    const Time now = clock_.now();
    permitted_ =
        supervisor_
            .judge(wish(input), {.scan = scan_, .wheels = wheels_, .input = input, .plan_stamp = now, .now = now})
            .permitted;
    base_.command(diff_drive_.wheel_speeds(permitted_, now));
    gate_.note_turning(std::fabs(wheels_.left_radps) > 0.1 || std::fabs(wheels_.right_radps) > 0.1);
    if (supervisor_.mode() == Mode::kLatched) panel_.input.has_goal = false;  // as the desk does
    hold_against_rules(now);
  }

  void hold_against_rules(Time now);
  void follow_bus();
  void accuse(const std::string& rule) {
    if (broken_.empty()) broken_ = rule + " in: " + state();
  }

  PlantClock clock_;
  InProcessBus bus_{clock_, 1};
  WatchedPort port_{bus_.port(0), clock_};
  emulators::Cia402Node left_{bus_.port(1), 5}, right_{bus_.port(2), 6};
  canopen::CanopenDriveBase base_;
  Panel panel_;
  ResetGate gate_{panel_, base_};
  Supervisor supervisor_{config()};
  DiffDrive diff_drive_{model().drive};
  LaserScan scan_{.stamp = Time{}};
  WheelState wheels_;
  Twist2 permitted_;
  bool scans_come_ = true, plugged_ = true, hangs_ = false;

  // What the rules remember.
  Mode before_ = Mode::kStandby;
  Time latched_ = kNever;
  double speed_latched_ = 0.0;   ///< counts/s
  bool reset_pressed_ = false;   ///< since it latched
  bool proof_owed_ = false;      ///< there was trouble, and since then no proof that began after a reset
  std::array<int, 2> proofs_{};  ///< writes to 1016h on the bus since the reset, by drive
  std::int32_t target_ = 0, target_before_ = 0;  ///< of the left drive, counts/s
  std::string broken_;
};

/// Counts what a proof must write, and follows the left drive's target.
inline void SafetyCore::follow_bus() {
  ReceivedFrame received;
  while (bus_.port(4).receive(received)) {
    const CanFrame& frame = received.frame;
    for (std::size_t k = 0; k < proofs_.size(); ++k) {
      const bool writes_watch = frame.id == 0x605U + k && (frame.bytes[0] & 0xE0U) == 0x20 && frame.bytes[1] == 0x16 &&
                                frame.bytes[2] == 0x10;
      if (writes_watch && reset_pressed_) ++proofs_[k];
    }
    if (frame.id != 0x205 || frame.size < 6) continue;
    target_before_ = target_;
    target_ = static_cast<std::int32_t>(static_cast<std::uint32_t>(frame.bytes[2]) | frame.bytes[3] << 8U |
                                        frame.bytes[4] << 16U | static_cast<std::uint32_t>(frame.bytes[5]) << 24U);
  }
}

inline void SafetyCore::hold_against_rules(Time now) {
  const Mode mode = supervisor_.mode();
  follow_bus();
  if (wheels_.trouble != DriveTrouble::kNone && !proof_owed_) proof_owed_ = true, proofs_ = {};
  if (mode == Mode::kLatched && before_ != Mode::kLatched) {
    latched_ = now;
    speed_latched_ = std::max(std::fabs(left_.velocity()), std::fabs(right_.velocity()));
    reset_pressed_ = false;
    proofs_ = {};
  }
  const bool was_proved = proofs_[0] > 0 && proofs_[1] > 0 && base_.is_proved();
  if (proof_owed_ && reset_pressed_ && was_proved) proof_owed_ = false;
  // 1: setpoints other than zero leave in three modes, and fall while latched.
  const bool may_move = row_of(mode).wire == WireOrder::kSetpoints || row_of(mode).wire == WireOrder::kRamp;
  if (target_ != 0 && !may_move) accuse("a setpoint left");
  if (mode == Mode::kLatched && target_ > target_before_ && before_ == Mode::kLatched) accuse("latched, and faster");
  // 2: from a fault to motion there is a reset and, where the drives were in trouble, their whole proof.
  if (mode == Mode::kDriving && before_ != Mode::kDriving) {
    if (latched_ != kNever && !reset_pressed_) accuse("it drives without a reset");
    if (proof_owed_) accuse("it drives without a proof");
  }
  // 3: latched for the ramp and 100 ms, both wheels stand or nothing is sent; and the tick in which that begins.
  const double ramp_s = speed_latched_ / (two_axes().stop.brake_radps2 * 1000.0);
  const bool is_due = mode == Mode::kLatched && now - latched_ > duration_from_seconds(ramp_s + 0.120);
  const bool turns = std::fabs(left_.velocity()) > 300.0 || std::fabs(right_.velocity()) > 300.0;  // 0.3 rad/s
  if (is_due && turns && now - port_.last() < std::chrono::milliseconds(20)) accuse("it turns, and is spoken to");
  before_ = mode;
}

}  // namespace jaywalk::tests
