#pragma once
// The device's end of a wire.
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "drivers/can/can_bus.h"
#include "drivers/wire/byte_reader.h"
#include "drivers/wire/file_descriptor.h"

namespace jaywalk::emulators {

/// The device's end of a wire that carries bytes, with one peer at a time. Nothing waits. Not for the loop.
class ByteServer {
 public:
  virtual ~ByteServer() = default;
  /// True while a client is connected; a newcomer takes its place.
  [[nodiscard]] bool has_peer() noexcept;
  /// Goes up by one with each peer.
  [[nodiscard]] std::uint64_t peers() const noexcept { return peers_; }
  /// What the peer sent since the last call.
  [[nodiscard]] wire::Bytes read() noexcept;
  /// Sends what can be sent at once. The rest waits where the wire lets it wait, and is lost where it does not.
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
  /// True where a sender waits for its peer to take what it sent.
  [[nodiscard]] virtual bool waits_for_peer() const noexcept = 0;

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
  explicit TcpServer(std::uint16_t port) : port_(port) { listen(); }
  [[nodiscard]] std::uint16_t port() const noexcept { return port_; }
  void set_present(bool present) override;

 private:
  wire::FileDescriptor accept() noexcept override;
  void before_drop(int peer) noexcept override;
  [[nodiscard]] bool waits_for_peer() const noexcept override { return true; }
  void listen();

  std::uint16_t port_;
  wire::FileDescriptor listener_;
};

/// A serial line: a pseudo terminal whose other end is found under `path`. It cannot tell whether
/// a reader is there; bytes that are not read are lost.
class PtyServer final : public ByteServer {
 public:
  /// Replaces the link `path`. Throws StartupError where this machine has no pseudo terminals.
  explicit PtyServer(std::string path) : path_(std::move(path)) { plug_in(); }
  ~PtyServer() override;
  [[nodiscard]] const std::string& path() const noexcept { return path_; }
  void set_present(bool present) override;

 private:
  wire::FileDescriptor accept() noexcept override { return std::exchange(fresh_, wire::FileDescriptor()); }
  void before_drop(int) noexcept override {}
  [[nodiscard]] bool waits_for_peer() const noexcept override { return false; }
  void plug_in();

  std::string path_;
  wire::FileDescriptor fresh_;  ///< this end, until it is accepted
  wire::FileDescriptor other_;  ///< the other end, held open so that this one can be read while nobody listens
};

/// The device's end of a line as a bus: frames carry its bytes.
class ServedBytes final : public CanBus {
 public:
  /// `clock` outlives it.
  ServedBytes(std::unique_ptr<ByteServer> wire, Clock& clock) noexcept : wire_(std::move(wire)), clock_(clock) {}

  [[nodiscard]] SendResult send(const CanFrame& frame) noexcept override {
    wire_->write(frame.payload());
    return SendResult::kQueued;
  }
  [[nodiscard]] bool receive(ReceivedFrame& received) noexcept override {
    if (waiting_.empty() && wire_->has_peer()) waiting_ = wire_->read();
    if (waiting_.empty()) return false;
    received = {first_frame(waiting_), clock_.now()};
    return true;
  }
  [[nodiscard]] CanHealth health() const noexcept override { return {}; }
  [[nodiscard]] ByteServer& wire() noexcept { return *wire_; }

 private:
  std::unique_ptr<ByteServer> wire_;
  Clock& clock_;
  wire::Bytes waiting_;
};

}  // namespace jaywalk::emulators
