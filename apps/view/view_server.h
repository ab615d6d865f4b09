#pragma once
// Serves the live page and its WebSocket from a thread of its own.
#include <atomic>
#include <filesystem>

#include "apps/view/view_door.h"
#include "firmware/robot/service_manager.h"

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
  [[nodiscard]] static std::unique_ptr<ViewServer> serve(const ViewAddress& where, ViewDoor door);
  ViewServer() = default;
  virtual ~ViewServer() = default;
  ViewServer(const ViewServer&) = delete;
  ViewServer& operator=(const ViewServer&) = delete;

  void push(MessageKind kind, std::string text) { push(kind, 0, kNever, std::move(text)); }
  void push(std::size_t channel, Time stamp, std::string text) {
    push(MessageKind::kTopic, channel, stamp, std::move(text));
  }
  /// Pages and subscribers that look now.
  [[nodiscard]] int viewers() const noexcept { return viewers_; }
  [[nodiscard]] bool has_pages() const noexcept { return has_pages_; }
  /// A bit a channel that a client subscribes to.
  [[nodiscard]] std::uint32_t wanted() const noexcept { return wanted_; }
  /// What to type into a browser; with the token where one is wanted.
  [[nodiscard]] const std::string& url() const noexcept { return url_; }
  /// SHA-256 of the certificate, as browsers show it; empty without TLS.
  [[nodiscard]] const std::string& fingerprint() const noexcept { return fingerprint_; }

 protected:
  Ring<ViewMessage, 64> ring_;  ///< a tick has ten topics and a frame at most
  std::atomic<int> viewers_{0};
  std::atomic<bool> has_pages_{false};
  std::atomic<std::uint32_t> wanted_{0};
  std::string url_, fingerprint_;

 private:
  void push(MessageKind kind, std::size_t channel, Time stamp, std::string text) {
    ViewMessage* const slot = ring_.draft();
    if (slot == nullptr) return;
    *slot = {kind, std::make_shared<const std::string>(std::move(text)), channel, stamp};
    ring_.publish();
  }
};

}  // namespace jaywalk::view
