#pragma once
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <string>
#include <vector>

#include "drivers/can/can_bus.h"
#include "drivers/wire/byte_reader.h"
#include "drivers/wire/file_descriptor.h"

namespace jaywalk::emulators {

/// Appends the lowest `bytes` bytes of a number, least significant first.
inline void put(std::vector<std::uint8_t>& message, std::int64_t number, int bytes) {
  for (int k = 0; k < bytes; ++k, number >>= 8) message.push_back(static_cast<std::uint8_t>(number));
}

struct Number {
  std::int64_t value;
  int bytes;
};
inline void put(std::vector<std::uint8_t>& message, std::initializer_list<Number> numbers) {
  for (const Number& each : numbers) put(message, each.value, each.bytes);
}

/// Remainder of `bytes` by a polynomial of degree `bits`, as a number with its leading one, by long division.
[[nodiscard]] inline unsigned crc(std::span<const std::uint8_t> bytes, unsigned bits, unsigned polynomial) noexcept {
  unsigned rest = 0;
  for (std::size_t bit = 0; bit < 8 * bytes.size() + bits; ++bit) {
    const unsigned next = bit / 8 < bytes.size() ? (static_cast<unsigned>(bytes[bit / 8]) >> (7 - bit % 8)) & 1U : 0U;
    rest = rest << 1U | next;
    if ((rest >> bits) != 0) rest ^= polynomial;
  }
  return rest;
}

/// The device's end of a wire that carries bytes, with one peer at a time. Nothing waits. Not for the loop.
class ByteServer {
 public:
  virtual ~ByteServer() = default;
  /// True while a client is connected; a newcomer takes its place.
  [[nodiscard]] bool has_peer() noexcept;
  /// Goes up by one with each peer.
  [[nodiscard]] std::uint64_t peers() const noexcept { return peers_; }
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

 private:
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
  ~PtyServer() override { set_present(false); }
  [[nodiscard]] const std::string& path() const noexcept { return path_; }
  void set_present(bool present) override;

 private:
  wire::FileDescriptor accept() noexcept override { return std::exchange(fresh_, wire::FileDescriptor()); }
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

  [[nodiscard]] bool send(const CanFrame& frame) noexcept override {
    wire_->write(frame.payload());
    return true;
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
