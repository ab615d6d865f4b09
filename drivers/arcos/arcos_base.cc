#include "drivers/arcos/arcos_base.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "drivers/can/can_bus.h"
#include "drivers/wired_drive.h"
#include "hal/shown_text.h"

namespace jaywalk::arcos {
namespace {

constexpr Duration kBoardSilence = std::chrono::milliseconds(150);
constexpr Duration kBoardAnswer = std::chrono::seconds(3);  // a connection at 20 Hz takes one
constexpr Duration kSettingsAnswer = std::chrono::seconds(1);
constexpr Duration kEcho = std::chrono::milliseconds(200);   // a SYNC without one is lost
constexpr Duration kApart = std::chrono::milliseconds(5);    // between two commands (Operations Manual)
constexpr Duration kOnLine = std::chrono::milliseconds(50);  // a report may be so long on a line of 9,600 baud
constexpr std::size_t kFirstSync = 2, kLastSync = 4, kFirstSetting = 9;

/// Its words lie within what a command can hold.
double within(double value) noexcept { return std::round(std::clamp(value, -30000.0, 30000.0)); }

constexpr const char* kRampRemedy = "lower [limits] of the model, or raise the board's own limits (ARCOScfg)";

int in_ms(Duration time) { return static_cast<int>(time / std::chrono::milliseconds(1)); }

}  // namespace

ArcosBase::ArcosBase(CanBus& bus, Clock& clock, const BaseSetup& setup)
    : MotorPair(bus, clock,
                {std::max({kBoardSilence, 3 * setup.tick, duration_from_seconds(setup.times.oldest_report_s())}),
                 kBoardAnswer, setup.stop, setup.allow_unproved, true}),
      bus_(bus),
      setup_(setup),
      script_{{{Command::kStop},
               {Command::kClose},
               {Command::kPulse},
               {Command::kOpen},
               {Command::kClose},
               {Command::kOpen},
               {Command::kPulse},
               {Command::kEncoders, 2},
               {Command::kSonar, 0},
               {Command::kAcceleration, setup.motion.ramp_mmps2},
               {Command::kAcceleration, static_cast<std::int16_t>(-setup.motion.ramp_mmps2)},
               {Command::kTurnAcceleration, setup.motion.turn_ramp_dps2},
               {Command::kTurnAcceleration, static_cast<std::int16_t>(-setup.motion.turn_ramp_dps2)},
               {Command::kTop, setup.motion.top_mmps},
               {Command::kTurnTop, setup.motion.turn_top_dps},
               {Command::kSettings, 1},
               {Command::kPulse}}},
      shown_(setup.times, setup.tick) {
  const auto is_length = [](double mm) { return std::isfinite(mm) && mm > 0.0; };
  if (std::all_of(setup.mm_per_rad.begin(), setup.mm_per_rad.end(), is_length) && is_length(setup.track_mm) &&
      setup.ticks_per_mm > 0)
    return;
  throw StartupError(setup.name + ": cannot be set up so", "give wheels, track and ticks that are lengths and numbers");
}

bool ArcosBase::is_open() const noexcept {
  const CanState state = bus_.health().state;
  return state != CanState::kDown && state != CanState::kBusOff;
}

StartupError ArcosBase::absence(std::size_t) const {
  if (!is_open())
    return {setup_.name + ": cannot be opened",
            "plug it in, join the group dialout, or correct [drive] device or host"};
  return {setup_.name + ": no Pioneer answers",
          "switch it on, see to the cable, correct baud or port, and end any other program that uses it"};
}

void ArcosBase::command(const WheelCommand& command) noexcept {
  MotorPair::command(command);
  say_orders();
}

void ArcosBase::disarm() noexcept {
  MotorPair::disarm();
  say_orders();
}

void ArcosBase::send_order(std::size_t index, MotorOrder order, double speed_radps) noexcept {
  orders_[index] = order;
  wanted_radps_[index] = speed_radps;
  ++ordered_;
  if (order == MotorOrder::kOff) leave_operation();
}

void ArcosBase::leave_operation() noexcept {
  for (std::size_t k = 0; k < 2; ++k) note_obeys(k, false);
  enabled_ = kNever;
}

/// Of the board; an hour where it has none.
Duration ArcosBase::watchdog() const noexcept {
  if (!settings_ || settings_->watchdog_ms == 0) return std::chrono::hours(1);
  return std::chrono::milliseconds(settings_->watchdog_ms);
}

/// One board: where a wheel is told nothing more, the other one is not either.
void ArcosBase::say_orders() noexcept {
  if (std::exchange(ordered_, 0) < 2) return;
  if (const auto word = word_for(std::max(orders_[0], orders_[1]))) say(*word);
}

std::optional<Word> ArcosBase::word_for(MotorOrder order) noexcept {
  if (order == MotorOrder::kOff) return motors_on_ ? std::optional(Word{Command::kEnable, 0}) : std::nullopt;
  if (order == MotorOrder::kNetworkStop) return Word{Command::kEmergencyStop};
  const Time now = clock().now();
  const Duration silent = age(sent_, now);
  const bool after_gap = silent >= 3 * watchdog() / 4;
  if (silent >= watchdog()) leave_operation();
  if (order == MotorOrder::kHold && said_.command == Command::kStop && !after_gap) {
    if (enabled_ == kNever) enabled_ = now;
    return Word{Command::kEnable, 1};
  }
  const double left = wanted_radps_[0] * setup_.mm_per_rad[0], right = wanted_radps_[1] * setup_.mm_per_rad[1];
  const double speed = within(0.5 * (left + right));
  const double turn = within((right - left) / setup_.track_mm * 180.0 / kPi);
  if (after_gap || (speed == 0.0 && turn == 0.0)) return Word{Command::kStop};
  const double off_speed = std::fabs(speed - told_mmps_);
  const double off_turn = std::fabs(turn - told_turn_dps_) * kPi / 180.0 * 0.5 * setup_.track_mm;
  const bool tells_turn = off_turn > off_speed || (off_turn == off_speed && said_.command == Command::kSpeed);
  return tells_turn ? Word{Command::kTurn, static_cast<std::int16_t>(turn)}
                    : Word{Command::kSpeed, static_cast<std::int16_t>(speed)};
}

void ArcosBase::say(const Word& word) noexcept {
  said_ = word;
  sent_ = clock().now();
  if (word.command == Command::kSpeed) told_mmps_ = word.argument;
  if (word.command == Command::kTurn) told_turn_dps_ = word.argument;
  if (word.command == Command::kStop || word.command == Command::kEmergencyStop) told_mmps_ = told_turn_dps_ = 0.0;
  in_frames(packet_of(word).on_line(), [this](const CanFrame& frame) { send(frame); });
}

void ArcosBase::take(const ReceivedFrame& received) noexcept {
  reader_.append(received.frame.payload());
  for (wire::Bytes body = reader_.next(); !body.empty(); body = reader_.next()) take_body(body, received.stamp);
}

void ArcosBase::take_body(wire::Bytes body, Time stamp) noexcept {
  if (awaits_echo_ && body[0] == at_ - kFirstSync) {
    awaits_echo_ = false;
    ++at_;
  }
  if (const auto report = report_in(body)) take_report(*report, stamp);
  if (const auto counts = encoders_in(body)) take_encoders(*counts, stamp);
  if (const auto settings = settings_in(body)) settings_ = settings;
}

void ArcosBase::take_report(const Report& report, Time stamp) noexcept {
  motors_on_ = report.motors_on;
  faults_ = report.faults;
  const bool obeys = motors_on_ && enabled_ != kNever && stamp - enabled_ > kOnLine;
  double fastest_radps = 0.0;
  for (std::size_t k = 0; k < 2; ++k) {
    const MotorAxis before = axis(k);
    const double speed_radps = report.speed_mmps[k] / setup_.mm_per_rad[k];
    note_heard(k, stamp);
    note_speed(k, stamp, speed_radps);
    if (!counts_) {
      const double since_s = before.placed == kNever ? 0.0 : to_seconds(stamp - before.placed);
      note_turned(k, stamp, 0.5 * (before.speed_radps + speed_radps) * since_s);
    }
    note_obeys(k, obeys);
    fastest_radps = std::max(fastest_radps, std::fabs(speed_radps));
  }
  shown_.note(clock().now(), fastest_radps);
  if (faults_ == 0) return;
  const bool is_button = (faults_ & kStopButton) != 0;
  report_fault(is_button ? DriveTrouble::kEmergency : DriveTrouble::kDriveFault, {DriveFaultKind::kArcos, 0, faults_});
}

void ArcosBase::take_encoders(const Encoders& counts, Time stamp) noexcept {
  for (std::size_t k = 0; counts_ && k < 2; ++k) {
    const double way_mm = counted((*counts_)[k], counts[k]) / static_cast<double>(setup_.ticks_per_mm);
    note_turned(k, stamp, way_mm / setup_.mm_per_rad[k]);
  }
  counts_ = counts;
}

// The connection, which is made anew for each proof.

void ArcosBase::wake(bool anew) noexcept {
  if (!anew) return static_cast<void>(recite(kFirstSetting));
  at_ = 0;
  awaits_echo_ = motors_on_ = false;
  enabled_ = kNever;
  counts_.reset();
  settings_.reset();
}

/// Says the next word before `end` where it is due; false: all are said.
bool ArcosBase::recite(std::size_t end) noexcept {
  if (at_ >= end) return false;
  const Duration since = age(sent_, clock().now());
  if (!is_open() || since < (awaits_echo_ ? kEcho : kApart)) return true;
  if (awaits_echo_) at_ = 0;
  awaits_echo_ = at_ >= kFirstSync && at_ <= kLastSync;
  say(script_[at_]);
  if (!awaits_echo_) ++at_;
  return true;
}

ProofResult ArcosBase::continue_proof(std::size_t index) noexcept {
  const Time now = clock().now();
  if (index == 0) {
    if (recite(script_.size())) return ProofResult::kUnderWay;
    if (!settings_ && age(sent_, now) < kSettingsAnswer) return ProofResult::kUnderWay;
    return judge_settings();
  }
  if (!shown_.is_over(now)) return ProofResult::kUnderWay;
  const bool stands = shown_.fastest_radps() <= setup_.stop.tolerance_radps;
  return stands && shown_.is_often_enough() && faults_ == 0 ? ProofResult::kPassed : ProofResult::kFailed;
}

/// The watchdog is the last.
std::array<ArcosBase::Compared, 9> ArcosBase::compared() const noexcept {
  const Settings& shown = *settings_;
  const MotionSettings& motion = setup_.motion;
  const int cycle_ms = static_cast<int>(std::lround(1e3 * setup_.times.report_s));
  const auto same = [](const char* name, int wanted, int shows, const char* remedy) {
    return Compared{name, wanted, wanted, shows, remedy};
  };
  return {same("SipCycle", cycle_ms, shown.cycle_ms, "write that as report_ms in [drive]"),
          same("TicksMM", setup_.ticks_per_mm, shown.ticks_per_mm, "write that as ticks_per_mm in [drive]"),
          same("TransAccel", motion.ramp_mmps2, shown.acceleration_mmps2, kRampRemedy),
          same("TransDecel", motion.ramp_mmps2, shown.deceleration_mmps2, kRampRemedy),
          same("RotAccel", motion.turn_ramp_dps2, shown.turn_acceleration_dps2, kRampRemedy),
          same("RotDecel", motion.turn_ramp_dps2, shown.turn_deceleration_dps2, kRampRemedy),
          same("TransVelMax", motion.top_mmps, shown.top_mmps, kRampRemedy),
          same("RotVelMax", motion.turn_top_dps, shown.turn_top_dps, kRampRemedy),
          {"Watchdog", in_ms(setup_.watchdog_least), in_ms(setup_.watchdog_most), shown.watchdog_ms,
           "set Watchdog in the board's FLASH (ARCOScfg), or allow_unproved at your own risk"}};
}

ProofResult ArcosBase::judge_settings() const noexcept {
  if (!is_pioneer()) return ProofResult::kFailed;
  const auto all = compared();
  const auto first_bad = std::ranges::find_if_not(all, &Compared::is_well);
  if (first_bad == all.end()) return ProofResult::kPassed;
  return first_bad + 1 == all.end() ? ProofResult::kUnproved : ProofResult::kFailed;
}

std::string ArcosBase::proof_line(std::size_t index) const {
  const std::string who = setup_.name + ": ";
  if (index == 1) {
    return who +
           formatted("%.0f reports a second%s, at most %.2f rad/s at commanded zero", shown_.per_second(),
                     counts_ ? " with encoders" : ", no encoders", shown_.fastest_radps()) +
           (faults_ == 0 ? "" : "; " + arcos_fault_words(faults_));
  }
  if (!settings_) return who + "does not tell its settings: NOT PROVED";
  std::string line = who + shown(settings_->type.data()) + " " + shown(settings_->subtype.data());
  if (!is_pioneer()) return line + ": is no Pioneer";
  bool well = true;
  for (const Compared& setting : compared()) {
    line += std::string(", ") + setting.name + " " + std::to_string(setting.shown);
    if (setting.is_well()) continue;
    well = false;
    line += " (wanted " + std::to_string(setting.least) +
            (setting.most != setting.least ? " to " + std::to_string(setting.most) : "") + ")";
  }
  return line + (well ? "" : ": NOT PROVED");
}

std::string ArcosBase::proof_remedy(std::size_t index) const {
  if (index == 1) {
    if (faults_ != 0) return "release the stop button, free the wheels, and begin anew";
    return shown_.is_often_enough() ? "see why the wheels turn" : shown_.remedy();
  }
  if (!settings_) return "see to its cable and its power";
  if (!is_pioneer()) return "this drive is for ARCOS boards of type Pioneer: P3-DX, P3-AT, PeopleBot";
  const auto all = compared();
  return std::ranges::find_if_not(all, &Compared::is_well)->remedy;
}

}  // namespace jaywalk::arcos
