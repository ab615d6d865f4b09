#pragma once
#include <algorithm>
#include <array>
#include <memory>
#include <mutex>

#include "drivers/can/can_bus.h"
#include "drivers/wire/byte_link.h"
#include "hal/hal.h"

namespace jaywalk {

/// The first of `bytes`, up to eight, as a frame; they are taken off.
[[nodiscard]] inline CanFrame first_frame(wire::Bytes& bytes) noexcept {
  CanFrame frame;
  frame.size = static_cast<std::uint8_t>(std::min(bytes.size(), frame.bytes.size()));
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
  ByteBus(std::unique_ptr<wire::Link> link, Clock& clock) noexcept;

  [[nodiscard]] SendResult send(const CanFrame& frame) noexcept override;
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
