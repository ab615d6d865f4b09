#include <algorithm>
#include <array>
#include <cassert>
#include <initializer_list>

#include "drivers/wire/byte_reader.h"
#include "hil/emulators/cia402_node.h"

namespace jaywalk::emulators {

using canopen::ObjectAddress;

namespace {

constexpr std::uint32_t kNoSuchObject = 0x06020000, kReadOnly = 0x06010002, kWrongLength = 0x06070010,
                        kUnknownCommand = 0x05040001, kOutOfRange = 0x06090030;
constexpr std::uint32_t kNoRemoteFrames = 1U << 30U;

/// Vendor, product code, revision, serial number.
constexpr std::array<std::uint32_t, 4> kIdentity{0x2F7, 0x402, 0x10001, 7};

using Indices = std::initializer_list<std::uint16_t>;

bool is_transmit_id(ObjectAddress address) noexcept {
  return address.sub == 1 && (address.index == 0x1800 || address.index == 0x1801);
}

CanFrame answer_frame(std::uint8_t node, const CanFrame& request, std::uint8_t command, std::uint32_t word,
                      std::uint8_t size = 8) noexcept {
  CanFrame frame{.id = 0x580U + node, .size = size, .bytes = request.bytes};  // the object's address stays
  frame.bytes[0] = command;
  wire::put_little_endian(word, std::span(frame.bytes).subspan(4));
  return frame;
}

}  // namespace

DriveObjects::DriveObjects() noexcept {
  add({0x1000, 0}, 4, 0x00020192, false);  // a servo drive of CiA 402
  add({0x6502, 0}, 4, 1U << 2U, false);    // profile velocity, and nothing else
  add({0x1018, 0}, 1, kIdentity.size(), false);
  for (std::uint8_t sub = 1; sub <= 4; ++sub) add({0x1018, sub}, 4, kIdentity[sub - 1], false);
  add({0x1016, 1}, 4, 0, true);
  add({0x1017, 0}, 2, 0, true);
  add({0x1029, 1}, 1, 0, true);  // a communication error takes it from Operational to Pre-operational
  for (const std::uint16_t communication : Indices{0x1400, 0x1401, 0x1800, 0x1801}) {
    add({communication, 1}, 4, 0x80000000, true);
    add({communication, 2}, 1, 255, true);
  }
  for (const std::uint16_t mapping : Indices{0x1600, 0x1601, 0x1A00, 0x1A01})
    for (std::uint8_t sub = 0; sub <= 4; ++sub) add({mapping, sub}, sub == 0 ? 1 : 4, 0, true);
  for (const std::uint16_t option : Indices{0x6007, 0x605A, 0x605B, 0x605C, 0x605D, 0x605E})
    add({option, 0}, 2, 0, true);
  add({0x6040, 0}, 2, 0, true);
  add({0x6041, 0}, 2, 0x0250, false);
  add({0x6060, 0}, 1, 0, true);
  add({0x6061, 0}, 1, 0, false);
  for (const std::uint16_t ramp : Indices{0x6083, 0x6084, 0x6085}) add({ramp, 0}, 4, 1000, true);
  add({0x6064, 0}, 4, 0, false);
  add({0x606C, 0}, 4, 0, false);
  add({0x60FF, 0}, 4, 0, true);
}

void DriveObjects::add(ObjectAddress address, std::uint8_t bytes, std::uint32_t value, bool writable) noexcept {
  const bool fits = objects_.push_back({address, bytes, value, value, writable, false});
  assert(fits);
  static_cast<void>(fits);
}

DriveObjects::Object* DriveObjects::find(ObjectAddress address) noexcept {
  auto* const found = std::ranges::find(objects_, address, &Object::address);
  return found == objects_.end() ? nullptr : found;
}

std::uint32_t DriveObjects::value(ObjectAddress address) const noexcept {
  const auto* const found = std::ranges::find(objects_, address, &Object::address);
  return found == objects_.end() ? 0 : found->value;
}

void DriveObjects::lack(ObjectAddress address) noexcept {
  if (Object* const object = find(address)) objects_.swap_remove(static_cast<std::size_t>(object - objects_.begin()));
}

void DriveObjects::fix(ObjectAddress address, std::uint32_t value) noexcept {
  if (Object* const object = find(address)) {
    object->value = object->stored = value;
    object->writable = false;
  }
}

void DriveObjects::know_no_remote_frames(bool strict) noexcept {
  keeps_bit_30_ = true;
  wants_bit_30_ = strict;
  for (Object& object : objects_)
    if (is_transmit_id(object.address) && !strict) object.value = object.stored = object.value | kNoRemoteFrames;
}

void DriveObjects::restore(bool all) noexcept {
  for (Object& object : objects_)
    if (all || object.address.index < 0x2000) object.value = object.stored;
}

/// 0, or the abort code.
std::uint32_t DriveObjects::write(ObjectAddress address, std::uint32_t value, std::size_t bytes) noexcept {
  Object* const object = find(address);
  if (object == nullptr) return kNoSuchObject;
  if (!object->writable) return kReadOnly;
  if (object->bytes != bytes) return kWrongLength;
  const bool lacks_bit_30 = keeps_bit_30_ && is_transmit_id(address) && (value & kNoRemoteFrames) == 0;
  if (lacks_bit_30 && wants_bit_30_) return kOutOfRange;
  if (!object->lies) object->value = lacks_bit_30 ? value | kNoRemoteFrames : value;
  return 0;
}

std::optional<CanFrame> DriveObjects::answer(std::uint8_t node, const CanFrame& frame) noexcept {
  if (frame.extended || frame.remote || frame.id != 0x600U + node || frame.size != 8) return std::nullopt;
  const std::uint8_t command = frame.bytes[0];
  if (command == 0x80) return std::nullopt;  // the client gave up
  const ObjectAddress address{wire::little_endian<std::uint16_t>(frame.payload().subspan(1)), frame.bytes[3]};
  const auto unused = static_cast<std::uint8_t>((command >> 2U) & 3U);
  if ((command & 0xF3U) == 0x23) {
    const std::uint32_t value = wire::little_endian<std::uint32_t>(frame.payload().subspan(4));
    const std::uint32_t code = write(address, value, 4U - unused);
    return answer_frame(node, frame, code == 0 ? 0x60 : 0x80, code, short_ && code == 0 ? 4 : 8);
  }
  if (command != 0x40) return answer_frame(node, frame, 0x80, kUnknownCommand);
  const Object* const object = find(address);
  if (object == nullptr) return answer_frame(node, frame, 0x80, kNoSuchObject);
  const auto answered = static_cast<std::uint8_t>(0x43U | static_cast<unsigned>((4 - object->bytes) << 2));
  return answer_frame(node, frame, answered, object->value,
                      static_cast<std::uint8_t>(short_ ? 4U + object->bytes : 8U));
}

}  // namespace jaywalk::emulators
