#pragma once
// What stands between a wish and a wheel, with everything else left away: desk, stop button, reset gate, supervisor, a
// drive base and two emulated drives, time moved on by hand. It holds the rules against every tick.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <string>

#include "drivers/can/in_process_bus.h"
#include "firmware/robot/operator_desk.h"
#include "firmware/safety/supervisor.h"
#include "hal/types/wheels.h"
#include "planner/motion/twist_ramp.h"
#include "tests/drivers/drive_plant.h"
#include "tests/drivers/watched_port.h"
#include "tests/safety/scans.h"

namespace jaywalk::tests {

class SafetyCore {
 public:
  SafetyCore() : base_(port_, clock_, two_axes()) {
    clock_.plant = [this](Time now) { left_.step(now), right_.step(now); };
    static_cast<void>(base_.arm());
    ticks(20);
  }

  // What may happen.
  /// Another one each time: one that is repeated is void after a stop.
  void give_goal() { ask("goto 50 0." + std::to_string(++goals_)); }
  void hold_stop(bool held) { button_.held = held; }
  /// An order at the desk.
  void ask(const std::string& line) {
    const std::string answer = desk_.obey(line);
    if (line.starts_with("stop")) note_stop(), stopping_ = true;
    if (answer == "going\n" && stopping_) accuse("a goal is taken on the way to rest");
    if (answer == "reset\n") reset_given_ = proof_asked_ = true;
    if (answer == "going\n") goal_given_ = true;
  }
  /// A goal between the judgement that latches and its being told, and a reset before the tick after.
  void ask_as_it_latches() { asks_as_it_latches_ = true; }
  void bring_scans(bool come) { scans_come_ = come; }
  void tell_network(std::uint8_t command) {
    CanFrame frame;
    frame.size = 2;
    frame.bytes = {command, 0};
    static_cast<void>(bus_.port(3).send(frame));
  }
  void cut_power() { right_.restart(); }
  void pull_cable() { right_.pull_cable(), plugged_ = false; }
  void plug_cable() { right_.plug_cable(), plugged_ = true; }
  void hang_drive() { left_.stick(), hangs_ = true; }
  void break_drive() { left_.raise_fault(0x2310); }
  void ticks(int count) {
    for (int k = 0; k < count; ++k) tick();
  }

  /// What tells one state from another; continuous quantities are left to the rules.
  [[nodiscard]] std::string state() const {
    std::ostringstream out;
    out << static_cast<int>(supervisor_.mode()) << ' ' << name(wheels_.trouble) << ' ' << name(wheels_.stop) << ' '
        << base_.is_proved() << base_.is_enabled() << ' ' << left_.state_name() << ' ' << right_.state_name() << ' '
        << (left_.velocity() != 0.0) << (right_.velocity() != 0.0) << ' ' << has_goal_ << button_.held << scans_come_
        << plugged_ << hangs_ << reset_given_ << goal_given_ << proof_owed_ << asks_as_it_latches_ << stopping_;
    return out.str();
  }
  /// The first rule that was broken; empty: none.
  [[nodiscard]] const std::string& broken() const noexcept { return broken_; }
  [[nodiscard]] Mode mode() const noexcept { return supervisor_.mode(); }

 private:
  /// In front of the desk, as a joystick is.
  struct StopButton final : OperatorPanel {
    explicit StopButton(OperatorPanel& behind_it) noexcept : behind(behind_it) {}
    [[nodiscard]] OperatorInput latest() noexcept override {
      OperatorInput input = behind.latest();
      input.emergency_stop = input.emergency_stop || held;
      return input;
    }
    OperatorPanel& behind;
    bool held = false;
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
    lay_beams(scan_, model().laser);
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
    has_goal_ = input.has_goal;
    if (button_.held) note_stop();
    const Time now = clock_.now();
    const Verdict verdict = supervisor_.judge(
        wish(input), {.scans = scan_, .wheels = wheels_, .input = input, .plan_stamp = now, .now = now});
    permitted_ = verdict.permitted;
    base_.command(wheel_speeds(model().drive, permitted_, now));
    const bool latches = supervisor_.mode() == Mode::kLatched && before_ != Mode::kLatched && asks_as_it_latches_;
    if (latches) give_goal();
    tell(verdict);
    hold_against_rules(now);
    if (latches) asks_as_it_latches_ = false, ask("reset");
  }
  void tell(const Verdict& verdict) {
    status_.running = true;
    status_.speed_mps =
        std::max(std::fabs(wheels_.left_radps), std::fabs(wheels_.right_radps)) * model().drive.wheel_radius_m;
    status_.proved = base_.is_proved();
    status_.drive = wheels_.trouble;
    status_.reasons = verdict.reasons;
    status_.latched = supervisor_.mode() == Mode::kLatched;
    status_.at_rest = permitted_ == Twist2{} && status_.speed_mps <= kAtRest_mps;
    gate_.note_turning(status_.speed_mps > kAtRest_mps);
    desk_.tell(status_);
  }
  void note_stop() {
    goal_given_ = false;
    if (supervisor_.mode() == Mode::kLatched) reset_given_ = false;
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
  OperatorDesk desk_{clock_, {}, [] { return std::string(); }};
  StopButton button_{desk_};
  ResetGate gate_{button_, desk_.permission(), base_};
  Supervisor supervisor_{config()};
  LaserScan scan_{.stamp = Time{}};
  WheelState wheels_;
  Twist2 permitted_;
  RunStatus status_;
  int goals_ = 0;
  bool has_goal_ = false, asks_as_it_latches_ = false;
  bool scans_come_ = true, plugged_ = true, hangs_ = false;

  // What the rules remember.
  Mode before_ = Mode::kStandby;
  Time latched_ = kNever;
  double speed_latched_ = 0.0;                       ///< counts/s
  bool reset_given_ = false;                         ///< since it latched, and since the last stop while it was
  bool goal_given_ = false;                          ///< since it latched, and since the last stop
  bool stopping_ = false, stopping_before_ = false;  ///< ordered to stop, and not at rest since; likewise, a tick ago
  bool proof_asked_ = false;     ///< by a reset since it latched, one that a stop took back among them
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
      if (writes_watch && proof_asked_) ++proofs_[k];
    }
    if (frame.id != 0x205 || frame.size < 6) continue;
    target_before_ = target_;
    std::memcpy(&target_, frame.bytes.data() + 2, sizeof target_);  // little-endian, as all our machines are
  }
}

inline void SafetyCore::hold_against_rules(Time now) {
  const Mode mode = supervisor_.mode();
  follow_bus();
  if (wheels_.trouble != DriveTrouble::kNone && !proof_owed_) proof_owed_ = true, proofs_ = {};
  if (mode == Mode::kLatched && before_ != Mode::kLatched) {
    latched_ = now;
    // The ramp begins at the last setpoint, which a wheel that speeds up is behind by two ticks.
    const double setpoint = std::max(std::abs(target_), std::abs(target_before_));
    speed_latched_ = std::max({setpoint, std::fabs(left_.velocity()), std::fabs(right_.velocity())});
    reset_given_ = goal_given_ = false;
    proof_asked_ = false;
    proofs_ = {};
  }
  const bool was_proved = proofs_[0] > 0 && proofs_[1] > 0 && base_.is_proved();
  if (proof_owed_ && was_proved) proof_owed_ = false;
  // 1: setpoints other than zero leave in three modes, and fall while latched.
  const bool may_move = mode != Mode::kStandby && mode != Mode::kArmed;
  if (target_ != 0 && !may_move) accuse("a setpoint left");
  if (mode == Mode::kLatched && target_ > target_before_ && before_ == Mode::kLatched) accuse("latched, and faster");
  // 2: from a fault to motion there is a reset and, where the drives were in trouble, their whole proof.
  if (mode == Mode::kDriving && before_ != Mode::kDriving) {
    if (latched_ != kNever && !reset_given_) accuse("it drives without a reset");
    if (!goal_given_) accuse("it drives to a goal from before a stop or a fault");
    if (proof_owed_) accuse("it drives without a proof");
  }
  // 3: latched for the ramp and 100 ms, both wheels stand or nothing is sent; and the tick in which that begins.
  const double ramp_s = speed_latched_ / (two_axes().stop.brake_radps2 * 1000.0);
  const bool is_due = mode == Mode::kLatched && now - latched_ > duration_from_seconds(ramp_s + 0.120);
  const bool turns = std::fabs(left_.velocity()) > 300.0 || std::fabs(right_.velocity()) > 300.0;  // 0.3 rad/s
  if (is_due && turns && now - port_.last() < std::chrono::milliseconds(20)) accuse("it turns, and is spoken to");
  // 4: a stop is obeyed to rest.
  stopping_ = stopping_ && status_.speed_mps > kAtRest_mps;
  if (stopping_ && stopping_before_ && target_ > target_before_) accuse("ordered to stop, and faster");
  stopping_before_ = stopping_;
  before_ = mode;
}

}  // namespace jaywalk::tests
