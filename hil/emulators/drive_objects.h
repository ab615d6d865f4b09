#pragma once
#include <cstdint>
#include <optional>

#include "drivers/can/can_bus.h"
#include "drivers/canopen/cia402.h"
#include "hal/types/fixed_vector.h"

namespace jaywalk::emulators {

/// The object dictionary of an emulated drive, and the SDO server before it (expedited transfers only).
class DriveObjects {
 public:
  /// Those of a CiA 402 drive with two PDOs each way, switched off, watching nobody.
  DriveObjects() noexcept;

  /// 0 for what is not there.
  [[nodiscard]] std::uint32_t value(canopen::ObjectAddress address) const noexcept;
  /// What the drive itself does; nothing happens for what is not there.
  void set(canopen::ObjectAddress address, std::uint32_t value) noexcept {
    if (Object* const object = find(address)) object->value = value;
  }
  /// The answer to an SDO request addressed to `node`; nothing where `frame` is none.
  [[nodiscard]] std::optional<CanFrame> answer(std::uint8_t node, const CanFrame& frame) noexcept;

  void lack(canopen::ObjectAddress address) noexcept;
  /// From now on it is read-only and holds this.
  void fix(canopen::ObjectAddress address, std::uint32_t value) noexcept;
  /// From now on writes are acknowledged and change nothing.
  void lie_about(canopen::ObjectAddress address) noexcept {
    if (Object* const object = find(address)) object->lies = true;
  }
  /// Makes its TPDOs answer no remote frames: bit 30 of their COB-IDs stays set whatever is written; `strict`: a write
  /// without it is refused.
  void know_no_remote_frames(bool strict) noexcept;
  /// Shortens its SDO answers to the bytes in use.
  void answer_short() noexcept { short_ = true; }

  /// What it holds now is what a restart brings back (1010h).
  void store() noexcept {
    for (Object& object : objects_) object.stored = object.value;
  }
  /// Power lost, or NMT reset: what was not stored is forgotten; of communication (1000h to 1FFFh) alone, or all.
  void restore(bool all) noexcept;

 private:
  struct Object {
    canopen::ObjectAddress address;
    std::uint8_t bytes = 0;
    std::uint32_t value = 0;
    std::uint32_t stored = 0;
    bool writable = true;
    bool lies = false;
  };

  void add(canopen::ObjectAddress address, std::uint8_t bytes, std::uint32_t value, bool writable) noexcept;
  [[nodiscard]] Object* find(canopen::ObjectAddress address) noexcept;
  [[nodiscard]] std::uint32_t write(canopen::ObjectAddress address, std::uint32_t value, std::size_t bytes) noexcept;

  FixedVector<Object, 64> objects_;
  bool keeps_bit_30_ = false, wants_bit_30_ = false, short_ = false;
};

}  // namespace jaywalk::emulators
