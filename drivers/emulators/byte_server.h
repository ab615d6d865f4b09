#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "drivers/wire/byte_reader.h"
#include "drivers/wire/file_descriptor.h"

namespace jaywalk::emulators {

/// The device's end of a wire that carries bytes, with one peer at a time. Nothing waits. Not for the loop.
class ByteServer {
 public:
  virtual ~ByteServer() = default;
  /// True while somebody is connected; a newcomer takes the place of who was there.
  [[nodiscard]] bool has_peer() noexcept;
  /// Goes up by one with each peer.
  [[nodiscard]] std::uint64_t peers() const noexcept { return peers_; }
  /// What the peer sent since the last call.
  [[nodiscard]] wire::Bytes read() noexcept;
  /// Queues and sends what can be sent; what a peer does not read in time is not sent at all.
  void write(wire::Bytes bytes);
  /// The wire is torn: the peer's connection is gone without a farewell.
  void drop_peer() noexcept;
  /// False: nothing is there to connect to, until true.
  virtual void set_present(bool present) = 0;

 protected:
  /// A new peer, or -1. Called while there is none, and while there is one.
  [[nodiscard]] virtual wire::FileDescriptor accept() noexcept = 0;
  /// Makes closing abrupt where the wire knows of a difference.
  virtual void before_drop(int peer) noexcept = 0;

 private:
  void flush() noexcept;

  wire::FileDescriptor peer_;
  std::uint64_t peers_ = 0;
  std::vector<std::uint8_t> room_ = std::vector<std::uint8_t>(4096);
  std::vector<std::uint8_t> unsent_;
};

/// A TCP port on all of this machine's addresses.
class TcpServer final : public ByteServer {
 public:
  /// 0 takes any free port. Throws StartupError where the port is taken.
  explicit TcpServer(std::uint16_t port);
  [[nodiscard]] std::uint16_t port() const noexcept { return port_; }
  void set_present(bool present) override;

 private:
  wire::FileDescriptor accept() noexcept override;
  void before_drop(int peer) noexcept override;
  void listen();

  std::uint16_t port_;
  wire::FileDescriptor listener_;
};

}  // namespace jaywalk::emulators
