#pragma once
// Serial lines and TCP connections that open again by themselves.
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include "drivers/wire/byte_reader.h"
#include "drivers/wire/file_descriptor.h"
#include "hal/types/time.h"

namespace jaywalk::wire {

/// Where a device is found that speaks in bytes, and how it is opened again and again.
struct Endpoint {
  std::string name;  ///< as a person would put it: "192.168.0.1:2112", "/dev/ttyUSB0"
  /// Opens it without waiting or allocating: the descriptor, which may still be connecting; -1 where that failed.
  std::function<FileDescriptor()> open;
};

/// A TCP port. The host's name is looked up once, here. Throws StartupError where `host` is no address and no name that
/// is known.
[[nodiscard]] Endpoint tcp_endpoint(const std::string& host, std::uint16_t port);

/// A serial line: 8 data bits, no parity, one stop bit, no flow control, nothing translated. What came in before it was
/// opened is thrown away. `path` need not exist yet: a device may be plugged in later. Throws StartupError for a rate
/// that no line has.
[[nodiscard]] Endpoint serial_endpoint(const std::string& path, std::uint32_t baud);

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
  explicit ByteLink(Endpoint endpoint) noexcept : endpoint_(std::move(endpoint)) {}

  [[nodiscard]] const std::string& name() const noexcept override { return endpoint_.name; }
  void open() noexcept override;
  void close() noexcept override;
  [[nodiscard]] State state() noexcept override;
  [[nodiscard]] Bytes read(std::span<std::uint8_t> room) noexcept override;
  void write(Bytes bytes) noexcept override;
  void wait(Duration most) noexcept override;

 private:
  Endpoint endpoint_;
  FileDescriptor file_;
  State state_ = State::kClosed;
};

/// A link to `host` and `port`, or, where `host` is empty, to the serial line `device`. Throws StartupError.
[[nodiscard]] std::unique_ptr<Link> make_byte_link(const std::string& host, std::uint16_t port,
                                                   const std::string& device, std::uint32_t baud);

/// Sets an open serial line to 8 data bits, no parity, one stop bit, no flow control, nothing translated, at any rate
/// (termios2; glibc's own calls know but a few). False where it does not take that.
[[nodiscard]] bool set_raw(int line, std::uint32_t baud) noexcept;

}  // namespace jaywalk::wire
