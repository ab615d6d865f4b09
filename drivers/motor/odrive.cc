#include "drivers/motor/odrive.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "drivers/wire/byte_reader.h"
#include "hal/shown_text.h"
#include "hal/types/errors.h"

namespace jaywalk::odrive {
namespace {

constexpr std::uint32_t kHeartbeat = 0x01, kEstop = 0x02, kWriteParameter = 0x04, kSetAxisState = 0x07,
                        kEstimates = 0x09, kSetControllerMode = 0x0B, kSetInputVelocity = 0x0D, kReboot = 0x16,
                        kClearErrors = 0x18, kUpdateMode = 0x1F;
constexpr std::uint32_t kVelocityControl = 2, kPassThrough = 1, kVelocityRamp = 2;

CanFrame command(std::uint8_t node, std::uint32_t number, std::uint8_t size, std::uint32_t first = 0,
                 std::uint32_t second = 0) noexcept {
  CanFrame frame{.id = static_cast<std::uint32_t>(node) << 5U | number, .size = size};
  wire::put_little_endian(first, frame.bytes);
  wire::put_little_endian(second, std::span(frame.bytes).subspan(4));
  return frame;
}

constexpr Duration kAnswerLimit = std::chrono::seconds(1);
/// An axis is set to say its heartbeat no more often (heartbeat_msg_rate_ms); more are a second axis with its number.
constexpr Duration kHeartbeatLeast = std::chrono::milliseconds(10);
constexpr Duration kFeeding = std::chrono::milliseconds(10);  ///< well within any watchdog that passes
constexpr double kStill_radps = 0.05;                         ///< noise of an encoder at rest
constexpr double kHeld_radps = 0.3;  ///< and of one whose motor is held: 3 cm/s at a wheel of 0.1 m

std::string in_hex(std::uint32_t number) { return formatted("%08Xh", static_cast<unsigned>(number)); }

}  // namespace

CanFrame set_axis_state(std::uint8_t node, std::uint8_t state) noexcept {
  return command(node, kSetAxisState, 4, state);
}

CanFrame set_velocity_mode(std::uint8_t node, bool ramped) noexcept {
  return command(node, kSetControllerMode, 8, kVelocityControl, ramped ? kVelocityRamp : kPassThrough);
}

CanFrame set_velocity(std::uint8_t node, float turns_per_s) noexcept {
  return command(node, kSetInputVelocity, 8, std::bit_cast<std::uint32_t>(turns_per_s));
}

CanFrame emergency_stop(std::uint8_t node) noexcept { return command(node, kEstop, 0); }

CanFrame clear_errors(std::uint8_t node) noexcept { return command(node, kClearErrors, 1); }

// CANSimple's messages from the host (firmware 0.6, table of messages in its CAN guide): E-stop, parameter access, axis
// state, controller mode, inputs and limits (0Bh to 13h), reboot, clear errors, position, gains, firmware update.
bool is_order(const CanFrame& frame, std::uint8_t node) noexcept {
  if (frame.extended || frame.id >> 5U != node) return false;
  const std::uint32_t number = frame.id & 0x1FU;
  const bool is_input = number >= 0x0B && number <= 0x13;
  constexpr std::array<std::uint32_t, 9> kOthers{
      kEstop, kWriteParameter, kSetAxisState, kReboot, kClearErrors, 0x19, 0x1A, 0x1B, kUpdateMode};
  return frame.remote || is_input || std::find(kOthers.begin(), kOthers.end(), number) != kOthers.end();
}

std::optional<Message> decode(const CanFrame& frame) noexcept {
  if (frame.extended || frame.remote) return std::nullopt;
  const auto node = static_cast<std::uint8_t>(frame.id >> 5U);
  wire::ByteReader reader(frame.payload());
  switch (frame.id & 0x1FU) {
    case kHeartbeat: {
      const Heartbeat heartbeat{reader.little<std::uint32_t>(), reader.little<std::uint8_t>(),
                                reader.little<std::uint8_t>()};
      return reader.ok() ? std::optional(Message{node, heartbeat}) : std::nullopt;
    }
    case kEstimates: {
      const EncoderEstimates said{std::bit_cast<float>(reader.little<std::uint32_t>()),
                                  std::bit_cast<float>(reader.little<std::uint32_t>())};
      const bool finite = std::isfinite(said.position_turns) && std::isfinite(said.velocity_turns_per_s);
      return reader.ok() && finite ? std::optional(Message{node, said}) : std::nullopt;
    }
    default: return std::nullopt;
  }
}

std::string error_words(std::uint32_t errors) {
  const std::string words = odrive_error_words(errors);
  return in_hex(errors) + (words.empty() ? "" : " (" + words + ")");
}

void WatchdogProof::begin(std::uint8_t node, Duration least, Duration most, Time now) noexcept {
  *this = WatchdogProof();
  node_ = node;
  least_ = least;
  most_ = most;
  result_ = ProofResult::kUnderWay;
  enter(Stage::kBegin, now);
}

void WatchdogProof::enter(Stage stage, Time now) noexcept {
  stage_ = stage;
  since_ = now;
}

std::span<const CanFrame> WatchdogProof::step(Time now, const AxisReport& axis) noexcept {
  due_count_ = 0;
  axis_ = axis;
  const bool held = stage_ == Stage::kClose || stage_ == Stage::kWithhold;
  if (held && std::fabs(axis.speed_radps) > kHeld_radps) {
    finish(ProofResult::kFailed, Verdict::kTurns);
  } else {
    switch (stage_) {
      case Stage::kBegin: begin_clearing(now); break;
      case Stage::kClear: clear(now); break;
      case Stage::kClose: close(now); break;
      case Stage::kWithhold: withhold(now); break;
      case Stage::kDone: break;
    }
  }
  return std::span(due_).first(due_count_);
}

void WatchdogProof::begin_clearing(Time now) noexcept {
  add(set_axis_state(node_, kIdle));
  add(set_velocity_mode(node_, true));
  add(set_velocity(node_, 0.0F));  // before the errors go: or the watchdog makes one of them again
  add(clear_errors(node_));
  fed_ = now;
  enter(Stage::kClear, now);
}

bool WatchdogProof::reaches(std::uint8_t state, Time now, Verdict otherwise) noexcept {
  if (was_heard() && axis_.state == state && axis_.errors == 0) return true;
  if (now - since_ > kAnswerLimit)
    finish(ProofResult::kFailed, was_heard() ? otherwise : Verdict::kSilent);
  else
    feed(now);
  return false;
}

void WatchdogProof::clear(Time now) noexcept {
  if (!reaches(kIdle, now, Verdict::kDoesNotClear)) return;
  if (std::fabs(axis_.speed_radps) > kStill_radps) return finish(ProofResult::kFailed, Verdict::kTurns);
  add(set_axis_state(node_, kClosedLoop));
  add(set_velocity(node_, 0.0F));
  fed_ = now;
  enter(Stage::kClose, now);
}

void WatchdogProof::close(Time now) noexcept {
  if (!reaches(kClosedLoop, now, Verdict::kDoesNotClose)) return;
  add(set_velocity(node_, 0.0F));
  enter(Stage::kWithhold, now);
}

void WatchdogProof::withhold(Time now) noexcept {
  const bool expired = axis_.expired != kNever && axis_.expired >= since_;
  after_ = (expired ? axis_.expired : now) - since_;
  const bool expired_as_05 = !expired && was_heard() && (axis_.errors & kWatchdogExpired05) != 0;
  if (expired_as_05 && axis_.state != kClosedLoop) return finish(ProofResult::kUnproved, Verdict::kOldFirmware);
  if (!expired && after_ < most_) return;
  if (!was_heard()) return finish(ProofResult::kFailed, Verdict::kSilent);
  if (!expired) return finish(ProofResult::kUnproved, Verdict::kNothingSaid);
  if (axis_.state == kClosedLoop) return finish(ProofResult::kUnproved, Verdict::kHoldsOn);
  if (after_ < least_) return finish(ProofResult::kUnproved, Verdict::kHasty);
  if (after_ > most_) return finish(ProofResult::kUnproved, Verdict::kLate);
  finish(ProofResult::kPassed, Verdict::kNone);
}

void WatchdogProof::feed(Time now) noexcept {
  if (now - fed_ < kFeeding) return;
  add(set_velocity(node_, 0.0F));
  fed_ = now;
}

void WatchdogProof::finish(ProofResult result, Verdict verdict) noexcept {
  result_ = result;
  verdict_ = verdict;
  stage_ = Stage::kDone;
  add(set_axis_state(node_, kIdle));
  add(clear_errors(node_));
}

std::string WatchdogProof::line() const {
  const std::string said = " " + std::to_string(after_ / std::chrono::milliseconds(1)) + " ms after the last command";
  switch (verdict_) {
    case Verdict::kSilent: return "no heartbeat any more: NOT PROVED";
    case Verdict::kDoesNotClear: return "errors " + error_words(axis_.errors) + " that do not clear: NOT PROVED";
    case Verdict::kTurns: return "turns, which it must not for the proof: NOT PROVED";
    case Verdict::kDoesNotClose:
      return "does not go to closed loop, errors " + error_words(axis_.errors) + ", procedure result " +
             std::to_string(axis_.procedure) + " (" + odrive_procedure_words(axis_.procedure) + "): NOT PROVED";
    case Verdict::kNothingSaid: return "watchdog: nothing said" + said + ": NOT PROVED";
    case Verdict::kOldFirmware:
      return "watchdog: expired" + said + " with error " + in_hex(axis_.errors) +
             ", as firmware 0.5 says it: its firmware is too old, 0.6 is wanted: NOT PROVED";
    case Verdict::kHoldsOn: return "watchdog: expired" + said + ", and holds on: NOT PROVED";
    case Verdict::kHasty: return "watchdog: expired" + said + ", too soon for two commands: NOT PROVED";
    case Verdict::kLate: return "watchdog: expired" + said + ", too late: NOT PROVED";
    case Verdict::kNone: break;
  }
  return "watchdog: expired" + said;
}

std::string WatchdogProof::remedy() const {
  switch (verdict_) {
    case Verdict::kSilent: return "see to its cable, its power and its node";
    case Verdict::kDoesNotClear: return "see to what its errors name";
    case Verdict::kTurns: return "see why its wheel turns";
    case Verdict::kDoesNotClose: return "see to what it names, and calibrate it anew, with odrivetool";
    default:
      return "set enable_watchdog, watchdog_timeout = 0.06 and can.heartbeat_msg_rate_ms = 10 in the ODrive, or "
             "allow_unproved at your own risk";
  }
}

OdriveBase::OdriveBase(CanBus& bus, Clock& clock, const BaseSetup& setup)
    : MotorPair(bus, clock, {setup.silence_limit, kAnswerLimit, setup.stop, setup.allow_unproved}), setup_(setup) {
  require_axes(setup.axes, "ODrive node", 0, 62);
}

std::string OdriveBase::inspect(std::size_t side) {
  await_motor(side);
  return who(side) + "heartbeat and encoder estimates; errors " + error_words(seen_[side].said.errors) +
         "; whether its watchdog lets go is seen at arming, which takes torque";
}

StartupError OdriveBase::absence(std::size_t index) const {
  if (axis(index).heard == kNever)
    return {who(index) + "no heartbeat", "see that the bus is up and the drive is powered"};
  return {who(index) + "no encoder estimates", "set can.encoder_msg_rate_ms = 10 in the ODrive"};
}

ProofResult OdriveBase::continue_proof(std::size_t index) noexcept {
  AxisReport& said = seen_[index].said;
  said.heard = axis(index).heard;
  said.speed_radps = axis(index).speed_radps;
  for (const CanFrame& frame : proofs_[index].step(clock().now(), said)) send(frame);
  return proofs_[index].result();
}

void OdriveBase::take(const ReceivedFrame& received) noexcept {
  for (const CanAxis& axis_setup : setup_.axes)
    if (is_order(received.frame, axis_setup.node)) return note_foreign(received.frame);
  const auto message = decode(received.frame);
  if (!message) return;
  for (std::size_t k = 0; k < setup_.axes.size(); ++k) {
    if (message->node != setup_.axes[k].node) continue;
    if (const auto* heartbeat = std::get_if<Heartbeat>(&message->content)) {
      if (!seen_[k].heartbeats.take_at(received.stamp, kHeartbeatLeast)) note_foreign(received.frame);
      take_heartbeat(k, *heartbeat, received.stamp);
    }
    if (const auto* estimates = std::get_if<EncoderEstimates>(&message->content))
      take_estimates(k, *estimates, received.stamp);
  }
}

void OdriveBase::take_heartbeat(std::size_t index, const Heartbeat& heartbeat, Time stamp) noexcept {
  AxisReport& said = seen_[index].said;
  const bool expired = (heartbeat.active_errors & kWatchdogExpired) != 0;
  if (!expired) said.expired = kNever;
  if (expired && said.expired == kNever) said.expired = stamp;
  said.errors = heartbeat.active_errors;
  said.state = heartbeat.axis_state;
  said.procedure = heartbeat.procedure;
  note_heard(index, stamp);
  note_obeys(index, heartbeat.axis_state == kClosedLoop && heartbeat.active_errors == 0);
  const DriveFault fault{DriveFaultKind::kOdrive, setup_.axes[index].node, heartbeat.active_errors};
  if ((heartbeat.active_errors & kEstopRequested) != 0) report_fault(DriveTrouble::kEmergency, fault);
  if (heartbeat.active_errors != 0) report_fault(DriveTrouble::kDriveFault, fault);
}

void OdriveBase::take_estimates(std::size_t index, const EncoderEstimates& estimates, Time stamp) noexcept {
  Seen& seen = seen_[index];
  const double turns_per_rad = setup_.axes[index].per_rad;
  const double turned = static_cast<double>(estimates.position_turns) - static_cast<double>(seen.position_turns);
  seen.position_turns = estimates.position_turns;
  note_turned(index, stamp, turned / turns_per_rad);
  note_speed(index, stamp, static_cast<double>(estimates.velocity_turns_per_s) / turns_per_rad);
}

void OdriveBase::send_order(std::size_t index, MotorOrder order, double speed_radps) noexcept {
  const std::uint8_t node = setup_.axes[index].node;
  // It disarms, and its wheel rolls out: nothing of an ODrive brakes without obeying.
  if (order == MotorOrder::kNetworkStop) return send(emergency_stop(node));
  if (order == MotorOrder::kOff && seen_[index].said.state != kIdle) send(set_axis_state(node, kIdle));
  if (order == MotorOrder::kHold && seen_[index].said.state != kClosedLoop) {
    send(set_velocity_mode(node, true));
    send(set_axis_state(node, kClosedLoop));
  }
  send(set_velocity(node, static_cast<float>(speed_radps * setup_.axes[index].per_rad)));
}

void OdriveBase::send_reset(std::size_t index) noexcept {
  send(set_velocity_mode(setup_.axes[index].node, true));
  send(set_velocity(setup_.axes[index].node, 0.0F));
  send(clear_errors(setup_.axes[index].node));
}

}  // namespace jaywalk::odrive
