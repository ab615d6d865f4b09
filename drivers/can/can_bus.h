#pragma once
// CAN frames, and a place on a bus.
#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <string_view>

#include "drivers/wire/byte_link.h"
#include "hal/hal.h"
#include "hal/types/time.h"

namespace jaywalk {

/// A classic CAN frame (ISO 11898-1): up to 8 bytes under an identifier of 11 bits, or 29 where `extended`.
struct CanFrame {
  std::uint32_t id = 0;
  bool extended = false;
  bool remote = false;    ///< asks for a frame of `size` bytes instead of carrying them
  std::uint8_t size = 0;  ///< bytes in use, at most 8; the others are 0
  std::array<std::uint8_t, 8> bytes{};

  [[nodiscard]] std::span<const std::uint8_t> payload() const noexcept { return {bytes.data(), size}; }
  bool operator==(const CanFrame&) const = default;
};

/// "701#05", as candump has it. Not for the loop.
[[nodiscard]] std::string to_text(const CanFrame& frame);

inline constexpr std::uint32_t kMaxStandardId = 0x7FF, kMaxExtendedId = 0x1FFFFFFF;

/// True for what can stand on a bus: identifier and size within their ranges.
[[nodiscard]] constexpr bool is_valid(const CanFrame& frame) noexcept {
  return frame.size <= 8 && frame.id <= (frame.extended ? kMaxExtendedId : kMaxStandardId);
}

/// A frame and when it came in (the kernel's stamp where there is one).
struct ReceivedFrame {
  CanFrame frame;
  Time stamp = kNever;
};

/// What a controller says about itself (ISO 11898-1 error states), and what may be wrong around it.
enum class CanState : std::uint8_t {
  kActive,   ///< all is well
  kWarning,  ///< an error counter above 96
  kPassive,  ///< above 127: it may no longer destroy others' frames
  kBusOff,   ///< above 255: it takes no part until it is restarted
  kDown      ///< the interface is down or gone
};

[[nodiscard]] std::string_view name(CanState state) noexcept;

struct CanHealth {
  CanState state = CanState::kActive;
  std::uint64_t error_frames = 0;  ///< since start
  std::uint64_t bus_off_count = 0;
  std::uint64_t frames_lost = 0;  ///< dropped because they were not fetched in time
  std::uint64_t malformed = 0;    ///< what the kernel handed over and was no frame
};

/// Frames that one tick takes in: a bus at 1 Mbit/s brings some 9000 a second.
inline constexpr int kMostFramesATick = 512;

/// One place on a CAN bus. Nothing here waits, allocates or throws; one thread uses it.
class CanBus {
 public:
  virtual ~CanBus() = default;
  /// True where the controller has it; that it reached a device is for others to say. False where its queue is full (no
  /// acknowledgement, or too much at once), off the bus, and for what is_valid() refuses.
  [[nodiscard]] virtual bool send(const CanFrame& frame) noexcept = 0;
  /// Takes the oldest frame that waits; false when there is none. Own frames do not come back.
  [[nodiscard]] virtual bool receive(ReceivedFrame& received) noexcept = 0;
  /// As known from what was received so far.
  [[nodiscard]] virtual CanHealth health() const noexcept = 0;
};

/// Whether a bus was well since it was last looked at. Thread: the bus's.
class BusWatch {
 public:
  /// What was before is forgotten.
  void begin(const CanHealth& health) noexcept { bus_offs_seen_ = health.bus_off_count; }
  /// False when the controller is passive, off or down now, or was off meanwhile: that may be over before anybody
  /// looks.
  [[nodiscard]] bool is_well(const CanHealth& health) noexcept {
    const bool takes_part = health.state == CanState::kActive || health.state == CanState::kWarning;
    const bool was_off = health.bus_off_count != bus_offs_seen_;
    begin(health);
    return takes_part && !was_off;
  }

 private:
  std::uint64_t bus_offs_seen_ = 0;
};

/// The first of `bytes`, up to eight, as a frame; they are taken off.
[[nodiscard]] inline CanFrame first_frame(wire::Bytes& bytes) noexcept {
  CanFrame frame{.size = static_cast<std::uint8_t>(std::min<std::size_t>(bytes.size(), 8))};
  std::copy_n(bytes.begin(), frame.size, frame.bytes.begin());
  bytes = bytes.subspan(frame.size);
  return frame;
}

/// Hands bytes on as frames.
template <class Take>
void in_frames(wire::Bytes bytes, Take take) noexcept {
  while (!bytes.empty()) take(first_frame(bytes));
}

/// A serial line or TCP connection as a bus with two places: its frames carry bytes of the stream. One that is lost is
/// down, and opened again twice a second. Thread: one, and any for send().
class ByteBus final : public CanBus {
 public:
  /// Begins to open. `clock` outlives it.
  ByteBus(std::unique_ptr<wire::Link> link, Clock& clock) noexcept : link_(std::move(link)), clock_(clock) { refill(); }

  [[nodiscard]] bool send(const CanFrame& frame) noexcept override;
  [[nodiscard]] bool receive(ReceivedFrame& received) noexcept override;
  [[nodiscard]] CanHealth health() const noexcept override;

 private:
  void refill() noexcept;

  std::unique_ptr<wire::Link> link_;
  Clock& clock_;
  mutable std::mutex turn_;  ///< of the threads; nothing waits while it is held
  Time opened_ = kNever, read_ = kNever;
  wire::Bytes waiting_;
  std::array<std::uint8_t, std::size_t{8} * kMostFramesATick> room_{};
};

}  // namespace jaywalk
