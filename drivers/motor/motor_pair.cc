#include "drivers/motor/motor_pair.h"

#include <algorithm>
#include <cmath>

#include "hal/shown_text.h"

namespace jaywalk {
namespace {

/// Longest time that a motor takes to get over its fault when it is enabled.
constexpr Duration kSettling = std::chrono::milliseconds(300);
constexpr Duration kShownFor = std::chrono::milliseconds(500);
constexpr int kReportsShown = 10;          // of the period stated, in a proof
constexpr double kShareShown = 0.8;        // of those that its period promises
constexpr double kLongestReport_s = 0.25;  // report_ms
/// Another controller commands at 20 Hz or more: in this time it is heard several times.
constexpr Duration kListening = std::chrono::milliseconds(300);

std::string in_words(const CanFrame& frame) {
  std::string words = formatted(frame.extended ? "%08Xh" : "%03Xh", static_cast<unsigned>(frame.id));
  if (frame.remote) return words + " (a request)";
  for (const std::uint8_t byte : frame.payload()) words += formatted(" %02X", static_cast<unsigned>(byte));
  return words;
}

}  // namespace

MotorPair::MotorPair(CanBus& bus, Clock& clock, const PairSetup& setup)
    : bus_(bus), clock_(clock), setup_(setup), ladders_{StopLadder(setup.stop), StopLadder(setup.stop)} {
  if (setup.stop.brake_radps2 > 0.0 && setup.stop.tolerance_radps > 0.0) return;
  throw StartupError("drives: a stop without braking or tolerance", "give both in rad/s2 and rad/s");
}

WheelState MotorPair::latest() noexcept {
  receive();
  watch();
  wheels_.trouble = trouble_;
  wheels_.fault = fault_;
  wheels_.stop = stop_;
  wheels_.ready = proved_ && armed_ && !awaits_zero_ && trouble_ == DriveTrouble::kNone && is_enabled();
  return wheels_;
}

void MotorPair::receive() noexcept {
  ReceivedFrame received;
  for (int taken = 0; taken < kMostFramesATick && bus_.receive(received); ++taken) {
    take(received);
    publish(received.stamp);
  }
}

void MotorPair::publish(Time stamp) noexcept {
  const auto complete = [](const MotorAxis& a) { return a.fresh_position && a.fresh_speed; };
  if (!std::all_of(axes_.begin(), axes_.end(), complete)) return;
  wheels_ = {.stamp = stamp,
             .sequence = counts_on_ ? wheels_.sequence + 1 : 1,
             .left_rad = axes_[0].turned_rad,
             .right_rad = axes_[1].turned_rad,
             .left_radps = axes_[0].speed_radps,
             .right_radps = axes_[1].speed_radps};
  counts_on_ = true;
  for (MotorAxis& a : axes_) a.fresh_position = a.fresh_speed = false;
}

void MotorPair::note_heard(std::size_t index, Time stamp) noexcept {
  MotorAxis& a = axes_[index];
  const bool is_judged = proving_ && setup_.proves_reports;
  if (!is_judged && a.heard != kNever && stamp - a.heard > setup_.silence_limit) lose_proof(DriveTrouble::kDriveSilent);
  a.heard = stamp;
}

void MotorPair::note_speed(std::size_t index, Time stamp, double speed_radps) noexcept {
  axes_[index].speed_radps = speed_radps;
  axes_[index].felt = stamp;
  axes_[index].fresh_speed = true;
}

void MotorPair::note_turned(std::size_t index, Time stamp, double turned_rad) noexcept {
  MotorAxis& a = axes_[index];
  const bool continues = a.placed != kNever;
  const bool slipped = continues && jumps(turned_rad, a.speed_radps, to_seconds(stamp - a.placed));
  if (slipped) lose_proof(DriveTrouble::kDriveRestarted);
  counts_on_ = counts_on_ && continues && !slipped;
  if (continues && !slipped) a.turned_rad += turned_rad;
  a.placed = stamp;
  a.fresh_position = true;
}

void MotorPair::note_foreign(const CanFrame& frame) noexcept {
  if (!foreign_) foreign_ = frame;
  if (armed_) latch(DriveTrouble::kForeignMaster);
}

void MotorPair::watch() noexcept {
  if (!armed_) return;
  if (!bus_watch_.is_well(bus_.health())) latch(DriveTrouble::kBusUnwell);
  for (MotorAxis& a : axes_) {
    if (is_late(a.heard) || is_late(a.felt) || is_late(a.placed)) lose_proof(DriveTrouble::kDriveSilent);
    if (a.was_enabled && !a.obeys) lose_proof(DriveTrouble::kLeftOperation);
    a.was_enabled = a.obeys && !awaits_zero_;
  }
}

// The first trouble is the one worth knowing: the others follow from it.
void MotorPair::latch(DriveTrouble trouble) noexcept {
  proved_ = proving_ = false;
  if (trouble_ == DriveTrouble::kNone) trouble_ = trouble;
}

/// A motor went its own way. Before the first command of zero it has no torque: then it is proved again, and no reset
/// is owed.
void MotorPair::lose_proof(DriveTrouble trouble) noexcept {
  if (proving_ || (armed_ && !awaits_zero_)) return latch(trouble);
  proved_ = false;
}

void MotorPair::report_fault(DriveTrouble trouble, const DriveFault& fault) noexcept {
  if (!armed_ || awaits_zero_ || clock_.now() <= settled_) return;
  note(fault);
  latch(trouble);
}

void MotorPair::reset() noexcept {
  if (!armed_ || proving_) return;  // a proof that is under way goes on
  trouble_ = DriveTrouble::kNone;
  fault_ = {};
  foreign_.reset();
  stop_ = StopStage::kNone;
  awaits_zero_ = true;
  for (std::size_t k = 0; k < axes_.size(); ++k) {
    axes_[k].silenced = false;
    ladders_[k].reset();
  }
}

// What a motor complains of while nobody commands it (its watchdog) is forgotten here; what remains is a fault.
void MotorPair::begin_enabling() noexcept {
  awaits_zero_ = false;
  settled_ = clock_.now() + kSettling;
  for (std::size_t k = 0; k < axes_.size(); ++k) send_reset(k);
}

MotorOrder MotorPair::order_now() const noexcept {
  if (!armed_ || awaits_zero_) return MotorOrder::kOff;
  if (trouble_ != DriveTrouble::kNone) return MotorOrder::kStop;
  return is_enabled() ? MotorOrder::kRun : MotorOrder::kHold;  // both wheels or none
}

void MotorPair::command(const WheelCommand& command) noexcept {
  if (armed_ && !proved_ && trouble_ == DriveTrouble::kNone) return prove();
  const bool zero = command.left_radps == 0.0 && command.right_radps == 0.0;
  if (awaits_zero_ && zero && proved_) begin_enabling();
  const bool finite = std::isfinite(command.left_radps) && std::isfinite(command.right_radps);
  const bool moves = order_now() == MotorOrder::kRun && finite && !zero;
  follow_stop(moves, {command.left_radps, command.right_radps});
  const MotorOrder order = order_now();
  const bool runs = moves && order == MotorOrder::kRun;
  tell(0, order, runs ? command.left_radps : 0.0);
  tell(1, order, runs ? command.right_radps : 0.0);
}

void MotorPair::tell(std::size_t index, MotorOrder order, double speed_radps) noexcept {
  MotorAxis& a = axes_[index];
  // Where one motor is told nothing more, the other one is told nothing more as soon as its wheel stands.
  if (stop_ == StopStage::kSilent && (ladders_[index].stage() == StopStage::kSilent || stands(index)))
    a.silenced = true;
  if (a.silenced) return;
  if (order == MotorOrder::kOff) a.was_enabled = false;  // it leaves operation because it is asked to
  const bool gives_up = ladders_[index].stage() == StopStage::kNetworkStop;
  send_order(index, gives_up ? MotorOrder::kNetworkStop : order, speed_radps);
}

/// Holds the stop against each wheel's own feedback, so that one which obeys goes on being braked.
void MotorPair::follow_stop(bool moves, const std::array<double, 2>& told_radps) noexcept {
  if (!armed_ || (awaits_zero_ && trouble_ == DriveTrouble::kNone)) return;
  for (std::size_t k = 0; k < axes_.size(); ++k) {
    const WheelFeedback felt{axes_[k].speed_radps, axes_[k].felt, moves ? told_radps[k] : 0.0};
    stop_ = std::max(stop_, ladders_[k].update(clock_.now(), !moves, trouble_ != DriveTrouble::kNone, {felt, felt}));
  }
  if (stop_ != StopStage::kNone) latch(DriveTrouble::kStopUnconfirmed);
}

bool MotorPair::stands(std::size_t index) const noexcept {
  const MotorAxis& a = axes_[index];
  return age(a.felt, clock_.now()) <= setup_.stop.fresh && std::fabs(a.speed_radps) <= setup_.stop.tolerance_radps;
}

void MotorPair::disarm() noexcept {
  if (armed_ && !awaits_zero_ && !(stands(0) && stands(1))) return command({clock_.now(), 0.0, 0.0});
  awaits_zero_ = true;
  proving_ = false;
  for (std::size_t k = 0; k < axes_.size(); ++k) tell(k, MotorOrder::kOff, 0.0);
  receive();
}

// The arming proof, at start-up and after every return.

std::vector<std::string> MotorPair::arm() {
  trouble_ = DriveTrouble::kNone;
  listen();
  begin_proofs();
  while (proving_ && !foreign_) {
    continue_proofs();
    pass_time();
  }
  std::vector<std::string> report = judge_proofs();
  armed_ = true;
  bus_watch_.begin(bus_.health());
  return report;
}

void MotorPair::listen() {
  foreign_.reset();
  for (const Time began = clock_.now(); clock_.now() - began < kListening && !foreign_;) pass_time();
}

std::vector<std::string> MotorPair::judge_proofs() const {
  if (foreign_) {
    throw StartupError("CAN: another program commands the drives: frame " + in_words(*foreign_),
                       "end that program, or take it off this bus; a frame of a drive's own came too often: give each "
                       "a number of its own, and an ODrive can.heartbeat_msg_rate_ms of 10 or more");
  }
  std::vector<std::string> report;
  for (std::size_t k = 0; k < axes_.size(); ++k) {
    if (results_[k] == ProofResult::kAbsent) throw absence(k);
    if (results_[k] == ProofResult::kUnderWay) continue;
    report.push_back(proof_line(k));
    if (!accepts(results_[k])) throw StartupError(report.back(), proof_remedy(k));
  }
  if (trouble_ != DriveTrouble::kNone)
    throw StartupError("CAN: " + std::string(name(trouble_)), "see that the bus is up and the drives are powered");
  return report;
}

std::string MotorPair::inspect(std::size_t side) {
  await_motor(side);
  begin_proof(side);
  ProofResult result = ProofResult::kUnderWay;
  while ((result = continue_proof(side)) == ProofResult::kUnderWay) pass_time();
  if (!accepts(result)) throw StartupError(proof_line(side), proof_remedy(side));
  return proof_line(side);
}

void MotorPair::await_motor(std::size_t index) {
  axes_[index].forget();
  wake(true);
  for (const Time began = clock_.now(); !axes_[index].shows_itself() && clock_.now() - began < setup_.answer_limit;) {
    wake(false);
    pass_time();
  }
  if (!axes_[index].shows_itself()) throw absence(index);
}

void MotorPair::prove() noexcept {
  if (!proving_) begin_proofs();
  continue_proofs();
}

void MotorPair::begin_proofs() noexcept {
  proving_ = true;
  proved_ = both_shown_ = false;
  under_proof_ = 0;
  results_ = {};
  proofs_began_ = clock_.now();
  for (MotorAxis& a : axes_) a.forget();
  wake(true);
}

/// One motor after the other, once both show themselves.
void MotorPair::continue_proofs() noexcept {
  if (both_shown_) return finish_proof(continue_proof(under_proof_));
  wake(false);
  const bool late = clock_.now() - proofs_began_ > setup_.answer_limit;
  for (under_proof_ = 0; under_proof_ < axes_.size(); ++under_proof_)
    if (!axes_[under_proof_].shows_itself()) return late ? finish_proof(ProofResult::kAbsent) : void();
  both_shown_ = true;
  under_proof_ = 0;
  begin_proof(0);
}

void MotorPair::finish_proof(ProofResult result) noexcept {
  results_[under_proof_] = result;
  if (result == ProofResult::kUnderWay) return;
  if (!accepts(result)) return latch(DriveTrouble::kNotProved);
  if (trouble_ != DriveTrouble::kNone) return;
  if (++under_proof_ < axes_.size()) return begin_proof(under_proof_);
  proving_ = false;
  proved_ = true;
}

void MotorPair::pass_time() {
  clock_.sleep_until(clock_.now() + std::chrono::milliseconds(1));
  receive();
}

Duration ShownReports::shown_for() const noexcept {
  return std::max(kShownFor, duration_from_seconds(kReportsShown * times_.report_s));
}

void ShownReports::begin(Time now) noexcept {
  *this = ShownReports(times_, tick_);
  began_ = now;
}

void ShownReports::note(Time now, double speed_radps) noexcept {
  if (++readings_ > 1) longest_ = std::max(longest_, now - read_);
  read_ = now;
  fastest_radps_ = std::fmax(fastest_radps_, std::fabs(speed_radps));
}

bool ShownReports::is_often_enough() const noexcept {
  const double stated = to_seconds(shown_for()) / times_.report_s;
  return readings_ >= std::floor(kShareShown * stated) &&
         longest_ <= duration_from_seconds(times_.oldest_report_s()) + tick_;
}

std::string ShownReports::remedy() const {
  const double report_s = to_seconds(shown_for()) / std::max(readings_, 1);
  const double late_s = std::max(to_seconds(longest_) - report_s, 0.0);
  return formatted(report_s <= kLongestReport_s
                       ? "write report_ms = %.0f and report_late_ms = %.0f in [drive], or have it published more often"
                       : "have it published at least 4 times a second (now every %.0f ms, up to %.0f ms late)",
                   std::ceil(1e3 * report_s), 10.0 * std::ceil(100.0 * late_s));
}

}  // namespace jaywalk
