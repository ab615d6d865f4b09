#pragma once
#include <string>

namespace jaywalk {

/// Sets a network interface down and up again: what brings a CAN controller back from bus-off where the driver knows no
/// restart. Needs CAP_NET_ADMIN; may wait for the hardware. Not for the loop.
/// Returns what went wrong; empty: it is up.
[[nodiscard]] std::string restart_link(const std::string& interface);

}  // namespace jaywalk
