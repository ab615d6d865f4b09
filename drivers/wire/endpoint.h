#pragma once
#include <sys/socket.h>

#include <cstdint>
#include <string>

#include "drivers/wire/file_descriptor.h"

namespace jaywalk::wire {

/// Where a device is found that speaks in bytes, and how it is opened again and again.
class Endpoint {
 public:
  virtual ~Endpoint() = default;
  /// Opens it without waiting or allocating: the descriptor, which may still be connecting; -1 where that failed.
  [[nodiscard]] virtual FileDescriptor open() const noexcept = 0;
  /// How a person would name it: "192.168.0.1:2112", "/dev/ttyUSB0".
  [[nodiscard]] virtual const std::string& name() const noexcept = 0;
};

/// A TCP port. The host's name is looked up once, at start.
class TcpEndpoint final : public Endpoint {
 public:
  /// Throws StartupError where `host` is no address and no name that is known.
  TcpEndpoint(const std::string& host, std::uint16_t port);
  [[nodiscard]] FileDescriptor open() const noexcept override;
  [[nodiscard]] const std::string& name() const noexcept override { return name_; }

 private:
  std::string name_;
  sockaddr_storage address_{};
  socklen_t address_size_ = 0;
};

/// A serial line: 8 data bits, no parity, one stop bit, no flow control, nothing translated.
class SerialEndpoint final : public Endpoint {
 public:
  /// `path` need not exist yet: a device may be plugged in later. Throws StartupError for a rate that no line has.
  SerialEndpoint(std::string path, std::uint32_t baud);
  /// What came in before it was opened is thrown away.
  [[nodiscard]] FileDescriptor open() const noexcept override;
  [[nodiscard]] const std::string& name() const noexcept override { return path_; }

 private:
  std::string path_;
  std::uint32_t baud_;
};

}  // namespace jaywalk::wire
