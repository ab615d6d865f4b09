#include "drivers/canopen/pdo.h"

namespace jaywalk::canopen {

std::size_t length_of(const PdoMapping& mapping) noexcept {
  std::size_t length = 0;
  for (const MappedObject& object : mapping) length += object.bytes;
  return length;
}

std::optional<CanFrame> pack(const PdoMapping& mapping, std::uint32_t id,
                             std::span<const std::uint32_t> values) noexcept {
  if (values.size() != mapping.size() || length_of(mapping) > 8) return std::nullopt;
  CanFrame frame;
  frame.id = id;
  for (std::size_t i = 0; i < mapping.size(); ++i) {
    for (std::uint8_t byte = 0; byte < mapping[i].bytes && byte < 4; ++byte) {
      frame.bytes[frame.size++] = static_cast<std::uint8_t>(values[i] >> (8U * byte));
    }
  }
  return frame;
}

std::optional<FixedVector<std::uint32_t, 8>> unpack(const PdoMapping& mapping, const CanFrame& frame) noexcept {
  if (frame.remote || frame.size > 8 || length_of(mapping) > frame.size) return std::nullopt;
  FixedVector<std::uint32_t, 8> values;
  std::size_t at = 0;
  for (const MappedObject& object : mapping) {
    std::uint32_t value = 0;
    for (std::uint8_t byte = 0; byte < object.bytes && byte < 4; ++byte) {
      value |= static_cast<std::uint32_t>(frame.bytes[at++]) << (8U * byte);
    }
    if (!values.push_back(value)) return std::nullopt;
  }
  return values;
}

// CiA 301: a PDO must be off (bit 31 of its COB-ID) and its mapping empty while it is mapped.
bool append_setup(const PdoSetup& setup, ObjectWrites& writes) noexcept {
  constexpr std::uint32_t kOff = 0x80000000;
  bool fits = writes.push_back({{setup.communication_index, 1}, setup.id | kOff, 4});
  fits = fits && writes.push_back({{setup.mapping_index, 0}, 0, 1});
  std::uint8_t entry = 0;
  for (const MappedObject& object : setup.mapping) {
    fits = fits && writes.push_back({{setup.mapping_index, ++entry}, object.mapping_word(), 4});
  }
  fits = fits && writes.push_back({{setup.mapping_index, 0}, entry, 1});
  fits = fits && writes.push_back({{setup.communication_index, 2}, setup.transmission_type, 1});
  return fits && writes.push_back({{setup.communication_index, 1}, setup.id, 4});
}

}  // namespace jaywalk::canopen
