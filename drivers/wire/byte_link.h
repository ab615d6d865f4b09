#pragma once
#include <memory>
#include <span>

#include "drivers/wire/byte_reader.h"
#include "drivers/wire/endpoint.h"
#include "hal/types/time.h"

namespace jaywalk::wire {

/// A connection to a device that carries bytes both ways, a TCP socket or a serial line. Only `wait` waits; nothing
/// allocates after construction. Thread: one.
class ByteLink {
 public:
  enum class State : std::uint8_t { kClosed, kOpening, kOpen };

  explicit ByteLink(std::unique_ptr<Endpoint> endpoint) noexcept : endpoint_(std::move(endpoint)) {}

  [[nodiscard]] const Endpoint& endpoint() const noexcept { return *endpoint_; }
  /// Begins to open; it stays closed where that fails at once.
  void open() noexcept;
  void close() noexcept;
  /// Asks the system how opening goes; a link that could not be opened is closed.
  [[nodiscard]] State state() noexcept;

  /// What came in, at most as much as `room` holds; empty where nothing waits. Closes where the far end is gone.
  [[nodiscard]] Bytes read(std::span<std::uint8_t> room) noexcept;
  /// Sends all of `bytes` or closes: a device that lets commands pile up is lost.
  void write(Bytes bytes) noexcept;
  /// Returns when there is something to read, when opening is done, or after `most`.
  void wait(Duration most) noexcept;

 private:
  std::unique_ptr<Endpoint> endpoint_;
  FileDescriptor file_;
  State state_ = State::kClosed;
};

}  // namespace jaywalk::wire
