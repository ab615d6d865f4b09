#include "drivers/motor/vesc.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "drivers/wire/byte_reader.h"
#include "hal/shown_text.h"
#include "hal/types/errors.h"

namespace jaywalk::vesc {
namespace {

constexpr std::uint32_t kSetCurrent = 1, kSetBrakeCurrent = 2, kSetErpm = 3, kPiece = 5, kLongPiece = 6, kPiecesEnd = 7,
                        kShort = 8, kStatus = 9, kStatus5 = 27;
// Commands inside messages 5 to 8 (COMM_GET_APPCONF, COMM_GET_VALUES_SELECTIVE), and the mask of the fault code.
constexpr std::uint8_t kGetSettings = 17, kGetValues = 50;
constexpr std::uint32_t kFaultCode = 1U << 15U;

CanFrame command(std::uint8_t controller, std::uint32_t number, std::int32_t value) noexcept {
  CanFrame frame{.id = number << 8U | controller, .extended = true, .size = 4};
  wire::put_big_endian(static_cast<std::uint32_t>(value), frame.bytes);
  return frame;
}

/// The content is the first number of a message that has `bytes` bytes at least.
template <class Content>
std::optional<Message> message_of(std::uint8_t controller, wire::ByteReader reader, std::size_t bytes) noexcept {
  if (reader.rest().size() < bytes) return std::nullopt;
  return Message{controller, Content{static_cast<std::int32_t>(reader.big<std::uint32_t>())}};
}

std::optional<Message> decode_piece(std::uint8_t to, wire::ByteReader reader, bool is_long) noexcept {
  Piece piece;
  piece.offset = is_long ? reader.big<std::uint16_t>() : reader.big<std::uint8_t>();
  const wire::Bytes rest = reader.rest();
  piece.size = static_cast<std::uint8_t>(rest.size());
  std::copy(rest.begin(), rest.end(), piece.bytes.begin());
  return reader.ok() ? std::optional(Message{to, piece}) : std::nullopt;
}

std::optional<Message> decode_end(std::uint8_t to, wire::ByteReader reader) noexcept {
  PiecesEnd end;
  end.from = reader.big<std::uint8_t>();
  reader.big<std::uint8_t>();  // what is to be done with it
  end.size = reader.big<std::uint16_t>();
  end.crc = reader.big<std::uint16_t>();
  return reader.ok() ? std::optional(Message{to, end}) : std::nullopt;
}

std::optional<Message> decode_fault(std::uint8_t to, wire::ByteReader reader) noexcept {
  Fault fault;
  fault.from = reader.big<std::uint8_t>();
  reader.big<std::uint8_t>();
  const bool is_fault = reader.big<std::uint8_t>() == kGetValues && reader.big<std::uint32_t>() == kFaultCode;
  fault.code = reader.big<std::uint8_t>();
  return is_fault && reader.ok() ? std::optional(Message{to, fault}) : std::nullopt;
}

constexpr Duration kAnswerLimit = std::chrono::milliseconds(500);
constexpr const char* kMinimumErpm =
    "; its minimum ERPM cannot be read: set it to 0 (VESC Tool, Motor Settings, PID Controllers)";
constexpr double kMostBrake_a = 200.0, kMostErpm = 1e6;  ///< more than any VESC and motor has
/// Electrical turns told, of which a motor that follows shows a sixth: 2 cm of a hub motor of 15 pole pairs, less than
/// by which wheels disobey (FeltMotion).
constexpr double kStill_turns = 0.5;

}  // namespace

CanFrame set_erpm(std::uint8_t controller, std::int32_t erpm) noexcept { return command(controller, kSetErpm, erpm); }

CanFrame set_current(std::uint8_t controller, std::int32_t milliampere) noexcept {
  return command(controller, kSetCurrent, milliampere);
}

CanFrame set_brake_current(std::uint8_t controller, std::int32_t milliampere) noexcept {
  return command(controller, kSetBrakeCurrent, milliampere);
}

CanFrame ask_settings(std::uint8_t controller, std::uint8_t own) noexcept {
  CanFrame frame = command(controller, kShort, 0);
  frame.size = 3;
  frame.bytes = {own, 0, kGetSettings};
  return frame;
}

CanFrame ask_fault(std::uint8_t controller, std::uint8_t own) noexcept {
  CanFrame frame = command(controller, kShort, 0);
  frame.size = 7;
  frame.bytes = {own, 0, kGetValues};
  wire::put_big_endian(kFaultCode, std::span(frame.bytes).subspan(3));
  return frame;
}

std::uint16_t crc16(wire::Bytes bytes) noexcept { return wire::crc_of<std::uint16_t>(bytes, 0x1021); }

// The firmware's numbers (CAN_PACKET_ID in its datatypes.h): 0 to 4 and 10 to 13 set, 5 to 8 carry messages, 17 pings,
// 19 and 21 to 26 measure and limit, 28 to 31 poll, limit and shut down. Everything else below 32 it sends itself.
bool is_order(const CanFrame& frame, std::uint8_t controller) noexcept {
  constexpr std::uint32_t kAll = 255;
  constexpr std::uint32_t kOrders = 0xF7EA3DFFU;  // a bit a number
  const std::uint32_t whom = frame.id & 0xFFU;
  const std::uint32_t number = frame.id >> 8U;
  if (!frame.extended || (whom != controller && whom != kAll)) return false;
  return number < 32 && ((kOrders >> number) & 1U) != 0;
}

std::optional<Message> decode(const CanFrame& frame) noexcept {
  if (!frame.extended || frame.remote) return std::nullopt;
  const auto controller = static_cast<std::uint8_t>(frame.id & 0xFFU);
  wire::ByteReader reader(frame.payload());
  switch (frame.id >> 8U) {
    case kPiece:
    case kLongPiece: return decode_piece(controller, reader, frame.id >> 8U == kLongPiece);
    case kPiecesEnd: return decode_end(controller, reader);
    case kShort: return decode_fault(controller, reader);
    case kStatus: return message_of<Status>(controller, reader, 8);   // current and duty cycle follow
    case kStatus5: return message_of<Travel>(controller, reader, 6);  // the supply voltage follows
    default: return std::nullopt;
  }
}

void SettingsReader::take(const Piece& piece) noexcept {
  const std::size_t end = static_cast<std::size_t>(piece.offset) + piece.size;
  if (piece.offset != filled_ || end > kMost) return;  // a gap: the checksum will not be reached
  std::copy_n(piece.bytes.begin(), piece.size, bytes_.begin() + piece.offset);
  filled_ = end;
}

std::optional<StopSettings> SettingsReader::finish(const PiecesEnd& end) const noexcept {
  const wire::Bytes all = wire::Bytes(bytes_).first(filled_);
  if (end.size != filled_ || crc16(all) != end.crc) return std::nullopt;
  wire::ByteReader reader(all);
  const bool is_answer = reader.big<std::uint8_t>() == kGetSettings;
  reader.big<std::uint32_t>();  // signature of the firmware's table of settings
  reader.big<std::uint8_t>();   // the controller's own number
  StopSettings settings;
  settings.timeout_ms = reader.big<std::uint32_t>();
  settings.brake_current_a = static_cast<double>(std::bit_cast<float>(reader.big<std::uint32_t>()));
  return is_answer && reader.ok() && std::isfinite(settings.brake_current_a) ? std::optional(settings) : std::nullopt;
}

VescBase::VescBase(CanBus& bus, Clock& clock, const BaseSetup& setup)
    : MotorPair(bus, clock, {setup.silence_limit, kAnswerLimit, setup.stop, setup.allow_unproved}), setup_(setup) {
  require_axes(setup.axes, "VESC", 0, 253, setup.own);
}

StartupError VescBase::absence(std::size_t index) const {
  return {who(index) + (axis(index).heard == kNever ? "no status message 1" : "no status message 5"),
          "see that it has power, and switch on status messages 1 and 5 at 50 Hz or more with VESC Tool"};
}

void VescBase::begin_proof(std::size_t index) noexcept {
  Seen& seen = seen_[index];
  reader_.begin();
  seen.settings.reset();
  seen.answered = seen.torque_on = false;
  seen.asked = clock().now();
  send(ask_settings(setup_.axes[index].node, setup_.own));
}

ProofResult VescBase::continue_proof(std::size_t index) noexcept {
  const Seen& seen = seen_[index];
  if (!seen.answered && clock().now() - seen.asked < kAnswerLimit) return ProofResult::kUnderWay;
  return seen.settings && is_proved_by(*seen.settings) ? ProofResult::kPassed : ProofResult::kUnproved;
}

bool VescBase::is_proved_by(const StopSettings& settings) const noexcept {
  const auto timeout = std::chrono::milliseconds(settings.timeout_ms);
  return timeout >= setup_.timeout_least && timeout <= setup_.timeout_most && settings.brake_current_a > 0.0;
}

std::string VescBase::proof_line(std::size_t index) const {
  const Seen& seen = seen_[index];
  if (!seen.settings)
    return who(index) + "timeout: " + (seen.answered ? "answer damaged" : "no answer") + ": NOT PROVED";
  const auto in_ms = [](Duration d) { return static_cast<int>(d / std::chrono::milliseconds(1)); };
  const std::string text =
      formatted("timeout: wanted %d to %d ms, reads %u ms, then brakes with %.1f A%s", in_ms(setup_.timeout_least),
                in_ms(setup_.timeout_most), static_cast<unsigned>(seen.settings->timeout_ms),
                seen.settings->brake_current_a, is_proved_by(*seen.settings) ? kMinimumErpm : ": NOT PROVED");
  return who(index) + text;
}

std::string VescBase::proof_remedy(std::size_t index) const {
  if (!seen_[index].answered)
    return "see to its cable, its power and its controller number; firmware 3.0 and newer answers";
  return "set timeout and timeout brake current (App Settings, General) with VESC Tool, or allow_unproved at your own "
         "risk";
}

void VescBase::take(const ReceivedFrame& received) noexcept {
  const CanFrame& frame = received.frame;
  const auto message = decode(frame);
  // The controller's own number is its alone: a frame with it answers the controller or is another master's.
  if (frame.extended && (frame.id & 0xFFU) == setup_.own) {
    if (!message || !take_answer(*message, received.stamp)) note_foreign(frame);
    return;
  }
  for (const CanAxis& axis_setup : setup_.axes)
    if (is_order(frame, axis_setup.node)) return note_foreign(frame);
  for (std::size_t k = 0; message && k < setup_.axes.size(); ++k)
    if (message->controller == setup_.axes[k].node) take_own(k, *message, received.stamp);
}

void VescBase::take_own(std::size_t index, const Message& message, Time stamp) noexcept {
  Seen& seen = seen_[index];
  const double turns = setup_.axes[index].per_rad;
  if (const auto* travel = std::get_if<Travel>(&message.content)) {
    const auto raw = static_cast<std::uint32_t>(travel->sixths_of_electrical_turn);
    note_turned(index, stamp, counted(seen.travel, raw) / (6.0 * turns));
    seen.travel = raw;
  }
  if (const auto* status = std::get_if<Status>(&message.content)) {
    note_heard(index, stamp);
    note_speed(index, stamp, status->erpm / (60.0 * turns));
    note_obeys(index, seen.torque_on && seen.fault == 0);
  }
}

bool VescBase::is_awaited(std::size_t index, Time stamp) const noexcept {
  return seen_[index].asked != kNever && stamp - seen_[index].asked < 2 * kAnswerLimit;
}

bool VescBase::take_answer(const Message& message, Time stamp) noexcept {
  if (const auto* fault = std::get_if<Fault>(&message.content)) return take_fault(*fault);
  if (const auto* piece = std::get_if<Piece>(&message.content)) {  // a piece names no sender
    reader_.take(*piece);
    return is_awaited(0, stamp) || is_awaited(1, stamp);
  }
  const auto* end = std::get_if<PiecesEnd>(&message.content);
  for (std::size_t k = 0; end != nullptr && k < setup_.axes.size(); ++k) {
    if (end->from != setup_.axes[k].node || !is_awaited(k, stamp)) continue;
    seen_[k].settings = reader_.finish(*end);
    seen_[k].answered = true;
    reader_.begin();
    return true;
  }
  return false;
}

bool VescBase::take_fault(const Fault& fault) noexcept {
  for (std::size_t k = 0; k < setup_.axes.size(); ++k) {
    if (fault.from != setup_.axes[k].node || seen_[k].open_asks == 0) continue;
    --seen_[k].open_asks;
    seen_[k].fault = fault.code;
    if (fault.code != 0) report_fault(DriveTrouble::kDriveFault, {DriveFaultKind::kVesc, fault.from, fault.code});
    return true;
  }
  return false;
}

void VescBase::send_order(std::size_t index, MotorOrder order, double speed_radps) noexcept {
  const CanAxis& axis_setup = setup_.axes[index];
  Seen& seen = seen_[index];
  seen.torque_on = order == MotorOrder::kHold || order == MotorOrder::kRun;
  const double brake_a = seen.settings ? std::clamp(seen.settings->brake_current_a, 0.0, kMostBrake_a) : 0.0;
  if (order == MotorOrder::kOff) {
    note_obeys(index, false);  // being told is enough: it cannot say that it let go
    send(set_current(axis_setup.node, 0));
  } else if (order == MotorOrder::kNetworkStop && brake_a > 0.0) {
    send(set_brake_current(axis_setup.node, static_cast<std::int32_t>(1000.0 * brake_a)));
  } else {
    const std::int32_t erpm = rounded_within(speed_radps * axis_setup.per_rad * 60.0, kMostErpm);
    hold_to_speed(index, order == MotorOrder::kRun, erpm);
    send(set_erpm(axis_setup.node, erpm));
  }
  ask_for_fault(index);
}

void VescBase::hold_to_speed(std::size_t index, bool runs, std::int32_t erpm) noexcept {
  Seen& seen = seen_[index];
  const std::uint8_t controller = setup_.axes[index].node;
  const Time now = clock().now();
  const double erpm_told = std::fabs(static_cast<double>(erpm));
  if (seen.travel != std::exchange(seen.stood_at, seen.travel)) {
    seen.told_turns = 0.0;
    withdraw(DriveFaultKind::kVescStill, controller);
  } else if (runs && seen.told != kNever) {
    seen.told_turns += erpm_told / 60.0 * to_seconds(now - seen.told);
  }
  seen.told = runs ? now : kNever;
  if (runs && seen.told_turns > kStill_turns)
    note({DriveFaultKind::kVescStill, controller, static_cast<std::uint32_t>(erpm_told)});
}

void VescBase::ask_for_fault(std::size_t index) noexcept {
  constexpr std::uint32_t kMostOpen =
      5;  // requests: some answers are late or lost, and an answer beyond them is another master's
  Seen& seen = seen_[index];
  seen.open_asks = std::min(seen.open_asks + 1, kMostOpen);
  send(ask_fault(setup_.axes[index].node, setup_.own));
}

}  // namespace jaywalk::vesc
