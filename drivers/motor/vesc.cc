#include "drivers/motor/vesc.h"

#include "drivers/wire/byte_reader.h"

namespace jaywalk::vesc {

namespace {

constexpr std::uint32_t kSetCurrent = 1, kSetBrakeCurrent = 2, kSetErpm = 3, kStatus = 9, kStatus4 = 16, kStatus5 = 27;

CanFrame command(std::uint8_t controller, std::uint32_t number, std::int32_t value) noexcept {
  CanFrame frame;
  frame.id = number << 8U | controller;
  frame.extended = true;
  frame.size = 4;
  wire::put_big_endian(static_cast<std::uint32_t>(value), frame.bytes);
  return frame;
}

std::int32_t word(wire::ByteReader& reader) noexcept { return static_cast<std::int32_t>(reader.big<std::uint32_t>()); }
double half_word(wire::ByteReader& reader) noexcept { return static_cast<std::int16_t>(reader.big<std::uint16_t>()); }

template <class Content>
std::optional<Message> message_of(std::uint8_t controller, const Content& content,
                                  const wire::ByteReader& reader) noexcept {
  return reader.ok() ? std::optional(Message{controller, content}) : std::nullopt;
}

}  // namespace

CanFrame set_erpm(std::uint8_t controller, std::int32_t erpm) noexcept { return command(controller, kSetErpm, erpm); }

CanFrame set_current(std::uint8_t controller, std::int32_t milliampere) noexcept {
  return command(controller, kSetCurrent, milliampere);
}

CanFrame set_brake_current(std::uint8_t controller, std::int32_t milliampere) noexcept {
  return command(controller, kSetBrakeCurrent, milliampere);
}

std::optional<Message> decode(const CanFrame& frame) noexcept {
  if (!frame.extended || frame.remote) return std::nullopt;
  const auto controller = static_cast<std::uint8_t>(frame.id & 0xFFU);
  wire::ByteReader reader(frame.payload());
  // Braced lists are evaluated in the order written.
  switch (frame.id >> 8U) {
    case kStatus:
      return message_of(controller, Status{word(reader), half_word(reader) / 10.0, half_word(reader) / 1000.0}, reader);
    case kStatus4:
      return message_of(controller,
                        Temperatures{half_word(reader) / 10.0, half_word(reader) / 10.0, half_word(reader) / 10.0},
                        reader);
    case kStatus5:
      return message_of(controller, Travel{word(reader), half_word(reader) / 10.0}, reader);
    default:
      return std::nullopt;
  }
}

}  // namespace jaywalk::vesc
