#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "drivers/can/can_bus.h"

namespace jaywalk {

/// What the kernel knows of a network interface.
struct LinkFacts {
  bool exists = false;
  bool is_can = false;
  bool is_up = false;
  std::string kind;               ///< "can" is a controller; "vcan", "slcan" and others; empty: none said
  std::uint32_t bitrate = 0;      ///< bit/s; 0: none set, or one that has none
  std::optional<CanState> state;  ///< of a controller
};

/// Asks rtnetlink. Start-up only; needs no privilege.
[[nodiscard]] LinkFacts link_facts(const std::string& interface);

/// The names of this machine's CAN interfaces, sorted, up or down. Start-up only.
[[nodiscard]] std::vector<std::string> can_interfaces();

}  // namespace jaywalk
