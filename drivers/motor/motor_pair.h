#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "drivers/can/can_bus.h"
#include "drivers/wired_drive.h"
#include "hal/types/errors.h"
#include "hal/types/robot_model.h"
#include "hal/types/time.h"

namespace jaywalk {

/// What one motor is told in a cycle.
enum class MotorOrder : std::uint8_t {
  kOff,         ///< no torque
  kHold,        ///< torque on, speed zero
  kRun,         ///< follow the speed
  kStop,        ///< speed zero because of trouble; nothing else that changes its state
  kNetworkStop  ///< what else the motor has that ends its obedience, where it does not obey speed zero
};

/// How the arming proof of one motor stands.
enum class ProofResult : std::uint8_t {
  kUnderWay,
  kPassed,
  kUnproved,  ///< it did not show that it stops by itself; all else is well
  kFailed,
  kAbsent  ///< it does not show itself
};

/// What is known of one motor, in the wheel's units.
struct MotorAxis {
  double turned_rad = 0.0;  ///< since start; goes on where a motor comes back
  double speed_radps = 0.0;
  bool fresh_position = false, fresh_speed = false;
  bool obeys = false;        ///< its torque is on and it follows speeds
  bool was_enabled = false;  ///< and was asked to
  Time heard = kNever;       ///< of the message that it always sends; kNever: not since its proof began
  Time felt = kNever;        ///< of the last speed; likewise
  Time placed = kNever;      ///< of the last position; likewise
  bool silenced = false;     ///< it is told nothing more until a reset

  /// All that it has to send by itself came since its proof began.
  [[nodiscard]] bool shows_itself() const noexcept { return heard != kNever && felt != kNever && placed != kNever; }
  /// Its proof begins: what it said before counts no more.
  void forget() noexcept {
    fresh_position = fresh_speed = obeys = was_enabled = false;
    heard = felt = placed = kNever;
  }
};

struct PairSetup {
  Duration silence_limit{};  ///< a motor that says nothing for so long is lost
  Duration answer_limit{};   ///< what a motor may take to show itself before its proof
  StopLimits stop;
  bool allow_unproved = false;
  bool proves_reports = false;  ///< the proof itself judges how often a motor says something
};

/// Two motors on one CAN bus that take speeds and watch over the time between commands themselves: what ODrive and VESC
/// have in common. Commands are sent by the tick and by nothing else, so a dead loop is a silent one.
///
/// Stops: at any trouble both are told to stand still, again with every command, until reset() and a command of zero.
/// Each wheel's feedback is held against the stop (StopLadder); where it does not show it, that motor is told to give
/// up obeying and then nothing more, and the other one is braked to rest and then told nothing more either.
///
/// Proof: arm() and every return run the same one, a step a cycle. Until both motors passed it nothing is sent but the
/// proof's own frames, so no motor has torque that the proof did not give it. Trouble of any kind, a motor that is
/// silent, restarts or leaves operation count as gone; a reset without any of these proves nothing anew.
///
/// One master: arm() listens before it sends; then and later a frame that only another master sends is trouble.
class MotorPair : public WiredDrive {
 public:
  std::vector<std::string> arm() override;
  [[nodiscard]] std::string inspect(std::size_t side) override;
  [[nodiscard]] WheelState latest() noexcept override;
  /// A speed that is not finite counts as zero for both.
  void command(const WheelCommand& command) noexcept override;
  [[nodiscard]] DriveTrouble trouble() const noexcept override { return trouble_; }
  [[nodiscard]] bool is_silent() const noexcept override { return is_late(axes_[0].heard) || is_late(axes_[1].heard); }
  void reset() noexcept override;
  [[nodiscard]] bool is_enabled() const noexcept override { return axes_[0].obeys && axes_[1].obeys; }
  [[nodiscard]] bool is_proved() const noexcept override { return proved_; }
  [[nodiscard]] std::optional<CanFrame> foreign_frame() const noexcept override { return foreign_; }
  /// Wheels that still turn are braked first.
  void disarm() noexcept override;

 protected:
  /// `bus` and `clock` outlive it. Throws StartupError where a stop has no ramp to be held against.
  MotorPair(CanBus& bus, Clock& clock, const PairSetup& setup);

  /// Takes in one frame; keeps its axis up to date.
  virtual void take(const ReceivedFrame& received) noexcept = 0;
  virtual void send_order(std::size_t axis, MotorOrder order, double speed_radps) noexcept = 0;
  /// Sends what makes the motor forget its fault, where it does not by itself.
  virtual void send_reset(std::size_t /*axis*/) noexcept {}
  /// Has motors show themselves that do not by themselves: once a cycle until they do; `anew`: when that begins.
  virtual void wake(bool /*anew*/) noexcept {}
  /// Begins the proof of one motor, which shows itself and stands by then.
  virtual void begin_proof(std::size_t axis) noexcept = 0;
  /// Carries it on by what is due; once a cycle.
  virtual ProofResult continue_proof(std::size_t axis) noexcept = 0;
  /// What the motor said in its proof, in a line. Start-up only, and so are these.
  [[nodiscard]] virtual std::string proof_line(std::size_t axis) const = 0;
  [[nodiscard]] virtual std::string proof_remedy(std::size_t axis) const = 0;
  /// Why a motor does not show itself, and what to do.
  [[nodiscard]] virtual StartupError absence(std::size_t axis) const = 0;

  [[nodiscard]] const MotorAxis& axis(std::size_t index) const noexcept { return axes_[index]; }
  [[nodiscard]] Clock& clock() noexcept { return clock_; }
  void send(const CanFrame& frame) noexcept {
    if (!bus_.send(frame)) latch(DriveTrouble::kBusRefused);
  }
  /// Lets a millisecond pass and takes in what came. Start-up only.
  void pass_time();
  /// Waits until the motor shows itself. Start-up only; throws absence().
  void await_motor(std::size_t index);

  /// What take() found: the message that the motor always sends;
  void note_heard(std::size_t index, Time stamp) noexcept;
  void note_speed(std::size_t index, Time stamp, double speed_radps) noexcept;
  /// how far the wheel turned since the message before: the first one after a return tells nothing;
  void note_turned(std::size_t index, Time stamp, double turned_rad) noexcept;
  /// that something is wrong, which counts once the motor had time to forget what was before it was enabled;
  void report_fault(DriveTrouble trouble, const DriveFault& fault) noexcept;
  /// what it tells about that: the first is the one worth knowing, unless it was only seen from here;
  void note(const DriveFault& fault) noexcept {
    if (!fault_.is_told() || fault_.kind == DriveFaultKind::kVescStill) fault_ = fault;
  }
  /// that it was wrong;
  void withdraw(DriveFaultKind kind, std::uint8_t node) noexcept {
    if (fault_.kind == kind && fault_.node == node) fault_ = {};
  }
  /// a frame that only another master sends.
  void note_foreign(const CanFrame& frame) noexcept;
  /// Whether its torque is on and it follows speeds.
  void note_obeys(std::size_t index, bool obeys) noexcept { axes_[index].obeys = obeys; }

 private:
  void receive() noexcept;
  void listen();
  [[nodiscard]] std::vector<std::string> judge_proofs() const;
  [[nodiscard]] bool accepts(ProofResult result) const noexcept {
    return result == ProofResult::kPassed || (result == ProofResult::kUnproved && setup_.allow_unproved);
  }
  void publish(Time stamp) noexcept;
  void watch() noexcept;
  /// Whether what comes regularly came too long ago.
  [[nodiscard]] bool is_late(Time stamp) const noexcept {
    return stamp != kNever && age(stamp, clock_.now()) > setup_.silence_limit;
  }
  void latch(DriveTrouble trouble) noexcept;
  void lose_proof(DriveTrouble trouble) noexcept;
  void prove() noexcept;
  void begin_proofs() noexcept;
  void continue_proofs() noexcept;
  void finish_proof(ProofResult result) noexcept;
  void begin_enabling() noexcept;
  void follow_stop(bool moves, const std::array<double, 2>& told_radps) noexcept;
  [[nodiscard]] bool stands(std::size_t index) const noexcept;
  [[nodiscard]] MotorOrder order_now() const noexcept;
  void tell(std::size_t index, MotorOrder order, double speed_radps) noexcept;

  CanBus& bus_;
  Clock& clock_;
  PairSetup setup_;
  std::array<MotorAxis, 2> axes_;  ///< left, right
  std::array<StopLadder, 2> ladders_;
  WheelState wheels_;
  bool counts_on_ = false;  ///< both angles, since the last reading
  DriveTrouble trouble_ = DriveTrouble::kNone;
  DriveFault fault_;
  StopStage stop_ = StopStage::kNone;
  bool armed_ = false, awaits_zero_ = true;
  bool proved_ = false, proving_ = false, both_shown_ = false;
  std::size_t under_proof_ = 0;  ///< the axis that is
  std::array<ProofResult, 2> results_{};
  Time proofs_began_ = kNever;
  std::optional<CanFrame> foreign_;  ///< the first one
  BusWatch bus_watch_;
  Time settled_ = kNever;
};

/// The difference between two readings of a counter that wraps at 32 bits, as a signed number.
[[nodiscard]] constexpr std::int32_t counted(std::uint32_t from, std::uint32_t to) noexcept {
  return static_cast<std::int32_t>(to - from);
}

/// Reports that a base shows in its arming proof, while it is told to stand: how many, how late, and of what speed.
class ShownReports {
 public:
  /// `tick`: how often they are read.
  ShownReports(const DriveTimes& times, Duration tick) noexcept : times_(times), tick_(tick) {}

  void begin(Time now) noexcept;
  void note(Time now, double speed_radps) noexcept;
  /// Long enough to tell how often it reports.
  [[nodiscard]] bool is_over(Time now) const noexcept { return now - began_ >= shown_for(); }
  /// As often as stated.
  [[nodiscard]] bool is_often_enough() const noexcept;
  [[nodiscard]] double per_second() const noexcept { return readings_ / to_seconds(shown_for()); }
  [[nodiscard]] double fastest_radps() const noexcept { return fastest_radps_; }
  /// Periods and delays that it showed, for the robot file; or that no robot file can have them. Start-up only.
  [[nodiscard]] std::string remedy() const;

 private:
  [[nodiscard]] Duration shown_for() const noexcept;

  DriveTimes times_;
  Duration tick_;
  Time began_ = kNever, read_ = kNever;
  int readings_ = 0;
  Duration longest_{};  ///< between two
  double fastest_radps_ = 0.0;
};

}  // namespace jaywalk
