#include "drivers/motor/vesc.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "drivers/wire/byte_reader.h"

namespace jaywalk::vesc {
namespace {

constexpr std::uint32_t kSetCurrent = 1, kSetBrakeCurrent = 2, kSetErpm = 3, kPiece = 5, kLongPiece = 6, kPiecesEnd = 7,
                        kShort = 8, kStatus = 9, kStatus5 = 27;
// Commands inside messages 5 to 8 (COMM_GET_APPCONF, COMM_GET_VALUES_SELECTIVE), and the mask of the fault code.
constexpr std::uint8_t kGetSettings = 17, kGetValues = 50;
constexpr std::uint32_t kFaultCode = 1U << 15U;

CanFrame command(std::uint8_t controller, std::uint32_t number, std::int32_t value) noexcept {
  CanFrame frame;
  frame.id = number << 8U | controller;
  frame.extended = true;
  frame.size = 4;
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

std::uint16_t crc16(std::span<const std::uint8_t> bytes) noexcept {
  unsigned crc = 0;
  for (const std::uint8_t byte : bytes) {
    crc ^= static_cast<unsigned>(byte) << 8U;
    for (int bit = 0; bit < 8; ++bit) crc = ((crc << 1U) ^ ((crc & 0x8000U) != 0 ? 0x1021U : 0U)) & 0xFFFFU;
  }
  return static_cast<std::uint16_t>(crc);
}

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

}  // namespace jaywalk::vesc
