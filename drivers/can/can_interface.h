#pragma once
// A CAN interface of this machine: its state, the right to it, its restart.
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "drivers/can/can_bus.h"
#include "drivers/wire/file_descriptor.h"

namespace jaywalk {

/// State and settings of a network interface, from the kernel.
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

/// The sole right on this machine to command what is on a CAN interface (SAFETY 16). It ends with the process, however
/// that ends, and counts where the interface does: a socket of the interface's network namespace, with no file.
/// Programs that do not ask for it, and other machines on the same wires,
/// are not kept away; what they send is a fault (DriveTrouble::kForeignMaster).
class BusLock {
 public:
  /// Throws StartupError where another process, or another lock of this one, has it.
  explicit BusLock(const std::string& interface);

 private:
  wire::FileDescriptor socket_;
};

/// Sets a network interface down and up again: what brings a CAN controller back from bus-off where the driver knows no
/// restart. Needs CAP_NET_ADMIN; may wait for the hardware. Not for the loop.
/// Returns what went wrong; empty: it is up.
[[nodiscard]] std::string restart_link(const std::string& interface);

}  // namespace jaywalk
