#pragma once
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "apps/view/foxglove_session.h"

namespace jaywalk::view {

/// Takes one text for the client that asked; empty: there is nothing to say. Any thread, once, now or later; does not
/// wait.
using Reply = std::function<void(std::string)>;

/// Whom the server asks.
struct ViewDoor {
  /// A JSON text of the page's, or a stop or a goal of others as such. Called on the server's thread: must not wait.
  std::function<void(std::string_view, Reply)> on_order;
  std::vector<FoxgloveChannel> channels = {};  ///< at most 32; numbered from 0
};

}  // namespace jaywalk::view
