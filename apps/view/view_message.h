#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "hal/types/time.h"

namespace jaywalk::view {

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
