#pragma once
// Live page's server: what it is given, what it calls, and its thread.
#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "apps/view/foxglove_session.h"
#include "firmware/recording/recorder.h"

namespace jaywalk::view {
/// Makes the calling thread one of ordinary priority that takes no signals. Threads of the page call it first: they
/// inherit priority and signals from the thread that made them.
void be_in_background() noexcept;

/// Takes one text for the client that asked; empty: there is nothing to say. Any thread, once; does not wait.
using Reply = std::function<void(std::string)>;

/// What the server calls when a client gives an order, and which channels it offers.
struct ViewDoor {
  /// A JSON text of the page's, or a stop or a goal of others as such. Called on the server's thread: must not wait.
  std::function<void(std::string_view, Reply)> on_order;
  std::vector<FoxgloveChannel> channels = {};  ///< at most 32; numbered from 0
  std::vector<FoxgloveParameter> parameters = {};
};

enum class MessageKind : std::uint8_t {
  kHello,  ///< also sent to clients that join later
  kField,  ///< the same
  kFrame,  ///< of this moment: left out for a client that has not yet taken the one before
  kEnd,    ///< a run's last frame: said to everybody, however slow
  kTopic,  ///< a message of a Foxglove channel
  kTime    ///< the run's clock, for Foxglove's clients
};

struct ViewMessage {
  MessageKind kind = MessageKind::kFrame;
  std::shared_ptr<const std::string> text;  ///< JSON; of a topic: CDR
  std::size_t channel = 0;
  Time stamp = kNever;
};

/// The page of page/, built into the program by embed.cmake.
[[nodiscard]] std::string_view live_page() noexcept;

struct ViewAddress {
  std::string address = "127.0.0.1";  ///< IPv4; any other than 127.0.0.1 is served by TLS and asks for a token
  std::uint16_t port = 0;             ///< 0: any that is free
  std::string origin;                 ///< one more site whose pages may open a WebSocket, such as https://example.org
  std::filesystem::path certificate;  ///< PEM with certificate and key; empty: one of our own (secret.h)
  bool wants_token = false;           ///< also on 127.0.0.1
};

/// Thread: push() belongs to one thread, everything else happens on the server's own. push() never waits: where the
/// ring is full, the message is left out; where a client does not read, that client's are.
class ViewServer {
 public:
  /// Throws StartupError where the address is none, the port is taken or the certificate cannot be used.
  [[nodiscard]] static std::unique_ptr<ViewServer> serve(const ViewAddress& where, ViewDoor door);
  virtual ~ViewServer() = default;

  void push(MessageKind kind, std::string text, Time stamp = kNever, std::size_t channel = 0) {
    ViewMessage* const slot = ring_.draft();
    if (slot == nullptr) return;
    *slot = {kind, std::make_shared<const std::string>(std::move(text)), channel, stamp};
    ring_.publish();
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
  Ring<ViewMessage, 64> ring_;  ///< a tick has 16 topics, its time and a frame at most
  std::atomic<int> viewers_{0};
  std::atomic<bool> has_pages_{false};
  std::atomic<std::uint32_t> wanted_{0};
  std::string url_, fingerprint_;
};

}  // namespace jaywalk::view
