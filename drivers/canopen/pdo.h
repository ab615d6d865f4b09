#pragma once
// Process data: objects packed into a frame, and the writes that make a drive do so (CiA 301).
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "drivers/can/can_frame.h"
#include "drivers/canopen/object_address.h"
#include "hal/types/fixed_vector.h"

namespace jaywalk::canopen {

/// One object inside a PDO; whole bytes only, 1 to 4 of them.
struct MappedObject {
  ObjectAddress address;
  std::uint8_t bytes = 0;

  /// As it stands in 1600h and 1A00h: index, sub-index, length in bits.
  [[nodiscard]] constexpr std::uint32_t mapping_word() const noexcept {
    return static_cast<std::uint32_t>(address.index) << 16U | static_cast<std::uint32_t>(address.sub) << 8U |
           static_cast<std::uint32_t>(bytes) * 8U;
  }
};

using PdoMapping = FixedVector<MappedObject, 8>;

/// Bytes that the mapping fills; a PDO has at most 8.
[[nodiscard]] std::size_t length_of(const PdoMapping& mapping) noexcept;

/// Packs one value an object (two's complement, cut to its bytes) under `id`. Nothing where counts or lengths do not
/// fit. A frame's unused bytes are 0.
[[nodiscard]] std::optional<CanFrame> pack(const PdoMapping& mapping, std::uint32_t id,
                                           std::span<const std::uint32_t> values) noexcept;

/// The values of a frame, each with zeros above its bytes. Nothing where the frame is shorter than the mapping; a
/// longer one is taken, as CiA 301 has it.
[[nodiscard]] std::optional<FixedVector<std::uint32_t, 8>> unpack(const PdoMapping& mapping,
                                                                  const CanFrame& frame) noexcept;

/// One write to a drive's object dictionary, of 1, 2 or 4 bytes.
struct ObjectWrite {
  ObjectAddress address;
  std::uint32_t value = 0;
  std::uint8_t bytes = 0;
  bool operator==(const ObjectWrite&) const = default;
};

using ObjectWrites = FixedVector<ObjectWrite, 64>;

/// Where a PDO's settings live: receive PDO n at 1400h + n - 1 and 1600h + n - 1, transmit at 1800h and 1A00h.
struct PdoSetup {
  std::uint16_t communication_index = 0;
  std::uint16_t mapping_index = 0;
  std::uint32_t id = 0;                ///< COB-ID, 11 bits
  std::uint8_t transmission_type = 0;  ///< 1: with every SYNC; 255: at once
  PdoMapping mapping;
};

/// Appends the writes that switch the PDO off, map it anew and switch it on. False where they do not fit.
[[nodiscard]] bool append_setup(const PdoSetup& setup, ObjectWrites& writes) noexcept;

}  // namespace jaywalk::canopen
