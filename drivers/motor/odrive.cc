#include "drivers/motor/odrive.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "drivers/wire/byte_reader.h"
#include "drivers/wired_drive.h"
#include "hal/shown_text.h"

namespace jaywalk::odrive {
namespace {

constexpr std::uint32_t kHeartbeat = 0x01, kEstop = 0x02, kWriteParameter = 0x04, kSetAxisState = 0x07,
                        kEstimates = 0x09, kSetControllerMode = 0x0B, kSetInputVelocity = 0x0D, kReboot = 0x16,
                        kClearErrors = 0x18, kUpdateMode = 0x1F;
constexpr std::uint32_t kVelocityControl = 2, kPassThrough = 1, kVelocityRamp = 2;

CanFrame command(std::uint8_t node, std::uint32_t number, std::uint8_t size, std::uint32_t first = 0,
                 std::uint32_t second = 0) noexcept {
  CanFrame frame;
  frame.id = static_cast<std::uint32_t>(node) << 5U | number;
  frame.size = size;
  wire::put_little_endian(first, frame.bytes);
  wire::put_little_endian(second, std::span(frame.bytes).subspan(4));
  return frame;
}

std::optional<Message> decode_estimates(std::uint8_t node, wire::ByteReader reader) noexcept {
  const auto position = std::bit_cast<float>(reader.little<std::uint32_t>());
  const auto velocity = std::bit_cast<float>(reader.little<std::uint32_t>());
  if (!reader.ok() || !std::isfinite(position) || !std::isfinite(velocity)) return std::nullopt;
  return Message{node, EncoderEstimates{position, velocity}};
}

constexpr Duration kAnswerLimit = std::chrono::seconds(1);
constexpr Duration kFeeding = std::chrono::milliseconds(10);  ///< well within any watchdog that passes
constexpr double kStill_radps = 0.05;                         ///< noise of an encoder at rest
constexpr double kHeld_radps = 0.3;  ///< and of one whose motor is held: 3 cm/s at a wheel of 0.1 m

std::string in_hex(std::uint32_t number) { return formatted("%08Xh", static_cast<unsigned>(number)); }

}  // namespace

CanFrame set_axis_state(std::uint8_t node, AxisState state) noexcept {
  return command(node, kSetAxisState, 4, static_cast<std::uint32_t>(state));
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
    case kEstimates: return decode_estimates(node, reader);
    default: return std::nullopt;
  }
}

std::string error_words(std::uint32_t errors) {
  const std::string words = odrive_error_words(errors);
  return in_hex(errors) + (words.empty() ? "" : " (" + words + ")");
}

void WatchdogProof::begin(std::uint8_t node, const ProofLimits& limits, Time now) noexcept {
  *this = WatchdogProof();
  node_ = node;
  limits_ = limits;
  result_ = ProofResult::kUnderWay;
  enter(Stage::kBegin, now);
}

void WatchdogProof::enter(Stage stage, Time now) noexcept {
  stage_ = stage;
  since_ = now;
}

std::span<const CanFrame> WatchdogProof::step(Time now, const AxisReport& axis) noexcept {
  due_count_ = 0;
  errors_ = axis.errors;
  procedure_ = axis.procedure;
  const bool held = stage_ == Stage::kClose || stage_ == Stage::kWithhold;
  if (held && std::fabs(axis.speed_radps) > kHeld_radps) {
    finish(ProofResult::kFailed, Verdict::kTurns);
  } else if (stage_ == Stage::kBegin) {
    add(set_axis_state(node_, AxisState::kIdle));
    add(set_velocity_mode(node_, true));
    add(set_velocity(node_, 0.0F));  // before the errors go: or the watchdog makes one of them again
    add(clear_errors(node_));
    fed_ = now;
    enter(Stage::kClear, now);
  } else if (stage_ == Stage::kClear) {
    clear(now, axis);
  } else if (stage_ == Stage::kClose) {
    close(now, axis);
  } else if (stage_ == Stage::kWithhold) {
    withhold(now, axis);
  }
  return std::span(due_).first(due_count_);
}

void WatchdogProof::clear(Time now, const AxisReport& axis) noexcept {
  if (axis.heard > since_ && axis.state == kIdle && axis.errors == 0) {
    if (std::fabs(axis.speed_radps) > kStill_radps) return finish(ProofResult::kFailed, Verdict::kTurns);
    add(set_axis_state(node_, AxisState::kClosedLoop));
    add(set_velocity(node_, 0.0F));
    fed_ = now;
    return enter(Stage::kClose, now);
  }
  if (now - since_ > kAnswerLimit)
    return finish(ProofResult::kFailed, was_heard(axis) ? Verdict::kDoesNotClear : Verdict::kSilent);
  feed(now);
}

void WatchdogProof::close(Time now, const AxisReport& axis) noexcept {
  if (axis.heard > since_ && axis.state == kClosedLoop && axis.errors == 0) {
    add(set_velocity(node_, 0.0F));
    return enter(Stage::kWithhold, now);
  }
  if (now - since_ > kAnswerLimit)
    return finish(ProofResult::kFailed, was_heard(axis) ? Verdict::kDoesNotClose : Verdict::kSilent);
  feed(now);
}

void WatchdogProof::withhold(Time now, const AxisReport& axis) noexcept {
  const bool expired = axis.expired != kNever && axis.expired >= since_;
  after_ = (expired ? axis.expired : now) - since_;
  const bool expired_as_05 = !expired && axis.heard > since_ && (axis.errors & kWatchdogExpired05) != 0;
  if (expired_as_05 && axis.state != kClosedLoop) return finish(ProofResult::kUnproved, Verdict::kOldFirmware);
  if (!expired && after_ < limits_.watchdog_most) return;
  if (!was_heard(axis)) return finish(ProofResult::kFailed, Verdict::kSilent);
  if (!expired) return finish(ProofResult::kUnproved, Verdict::kNothingSaid);
  if (axis.state == kClosedLoop) return finish(ProofResult::kUnproved, Verdict::kHoldsOn);
  if (after_ < limits_.watchdog_least) return finish(ProofResult::kUnproved, Verdict::kHasty);
  if (after_ > limits_.watchdog_most) return finish(ProofResult::kUnproved, Verdict::kLate);
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
  add(set_axis_state(node_, AxisState::kIdle));
  add(clear_errors(node_));
}

std::string WatchdogProof::line() const {
  const std::string said = " " + std::to_string(std::chrono::duration_cast<std::chrono::milliseconds>(after_).count()) +
                           " ms after the last command";
  switch (verdict_) {
    case Verdict::kSilent: return "no heartbeat any more: NOT PROVED";
    case Verdict::kDoesNotClear: return "errors " + error_words(errors_) + " that do not clear: NOT PROVED";
    case Verdict::kTurns: return "turns, which it must not for the proof: NOT PROVED";
    case Verdict::kDoesNotClose:
      return "does not go to closed loop, errors " + error_words(errors_) + ", procedure result " +
             std::to_string(procedure_) + " (" + odrive_procedure_words(procedure_) + "): NOT PROVED";
    case Verdict::kNothingSaid: return "watchdog: nothing said" + said + ": NOT PROVED";
    case Verdict::kOldFirmware:
      return "watchdog: expired" + said + " with error " + in_hex(errors_) +
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

}  // namespace jaywalk::odrive
