#pragma once
#include <memory>
#include <span>

#include "drivers/wire/byte_reader.h"
#include "drivers/wire/endpoint.h"
#include "hal/types/time.h"

namespace jaywalk::wire {

/// A connection to a device. Only `wait` waits; nothing allocates after construction. Thread: one.
class Link {
 public:
  enum class State : std::uint8_t { kClosed, kOpening, kOpen };

  virtual ~Link() = default;
  /// As a person would name the far end.
  [[nodiscard]] virtual const std::string& name() const noexcept = 0;
  /// Begins to open; it stays closed where that fails at once.
  virtual void open() noexcept = 0;
  virtual void close() noexcept = 0;
  /// Asks the system how opening goes; a link that could not be opened is closed.
  [[nodiscard]] virtual State state() noexcept = 0;

  /// What came in, in `room` or in memory of the link's own, until the next call; empty where nothing waits. Closes
  /// where the far end is gone.
  [[nodiscard]] virtual Bytes read(std::span<std::uint8_t> room) noexcept = 0;
  /// Sends all of `bytes` or closes: a device that lets commands pile up is lost.
  virtual void write(Bytes bytes) noexcept = 0;
  /// Returns when there is something to read, when opening is done, or after `most`.
  virtual void wait(Duration most) noexcept = 0;
};

/// One that carries bytes both ways, a TCP socket or a serial line; it reads at most as much as `room` holds.
class ByteLink final : public Link {
 public:
  explicit ByteLink(std::unique_ptr<Endpoint> endpoint) noexcept : endpoint_(std::move(endpoint)) {}

  [[nodiscard]] const std::string& name() const noexcept override { return endpoint_->name(); }
  void open() noexcept override;
  void close() noexcept override;
  [[nodiscard]] State state() noexcept override;
  [[nodiscard]] Bytes read(std::span<std::uint8_t> room) noexcept override;
  void write(Bytes bytes) noexcept override;
  void wait(Duration most) noexcept override;

 private:
  std::unique_ptr<Endpoint> endpoint_;
  FileDescriptor file_;
  State state_ = State::kClosed;
};

/// A link to `host` and `port`, or, where `host` is empty, to the serial line `device`. Throws StartupError.
[[nodiscard]] std::unique_ptr<Link> make_byte_link(const std::string& host, std::uint16_t port,
                                                   const std::string& device, std::uint32_t baud);

}  // namespace jaywalk::wire
