#pragma once
// Serves the live page and its WebSocket from a thread of its own.
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "apps/view/view_door.h"
#include "apps/view/view_message.h"
#include "hal/types/time.h"

namespace jaywalk::view {

struct ViewAddress {
  std::string address = "127.0.0.1";  ///< IPv4; any other than 127.0.0.1 is served by TLS and asks for a token
  std::uint16_t port = 0;             ///< 0: any that is free
  std::string origin;                 ///< one more site whose pages may open a WebSocket, such as https://example.org
  std::filesystem::path certificate;  ///< PEM with certificate and key; empty: one of our own (certificate.h)
  bool wants_token = false;           ///< also on 127.0.0.1
};

/// Thread: push() belongs to one thread, everything else happens on the server's own. push() never waits: where the
/// ring is full, the message is left out; where a client does not read, that client's are.
class ViewServer {
 public:
  /// Throws StartupError where the address is none, the port is taken or the certificate cannot be used.
  ViewServer(const ViewAddress& where, ViewDoor door);
  ~ViewServer();

  void push(MessageKind kind, std::string text);
  void push(std::size_t channel, Time stamp, std::string message);
  /// Pages and subscribers that look now.
  [[nodiscard]] int viewers() const noexcept;
  [[nodiscard]] bool has_pages() const noexcept;
  /// A bit a channel that a client subscribes to.
  [[nodiscard]] std::uint32_t wanted() const noexcept;
  /// What to type into a browser; with the token where one is wanted.
  [[nodiscard]] std::string url() const;
  /// SHA-256 of the certificate, as browsers show it; empty without TLS.
  [[nodiscard]] std::string fingerprint() const;

 private:
  class House;
  std::unique_ptr<House> house_;
};

}  // namespace jaywalk::view
