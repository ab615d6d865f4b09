#pragma once
// What passes between a program and the clients of its live page.
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "apps/view/foxglove_session.h"

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
};

enum class MessageKind : std::uint8_t {
  kHello,  ///< also sent to clients that join later
  kField,  ///< the same
  kFrame,  ///< of this moment: left out for a client that has not yet taken the one before
  kEnd,    ///< a run's last frame: said to everybody, however slow
  kTopic   ///< a message of a Foxglove channel
};

struct ViewMessage {
  MessageKind kind = MessageKind::kFrame;
  std::shared_ptr<const std::string> text;  ///< JSON; of a topic: CDR
  std::size_t channel = 0;
  Time stamp = kNever;
};

}  // namespace jaywalk::view
