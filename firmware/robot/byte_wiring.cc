#include "firmware/robot/byte_wiring.h"

namespace jaywalk {

ByteWiring read_byte_wiring(TomlTable& table, const std::string& what, std::uint16_t makers_port,
                            std::uint32_t makers_baud) {
  ByteWiring wiring;
  if (table.has("host") && table.has("device"))
    table.refuse("device", "stands beside host", "keep the one by which this " + what + " is connected");
  if (makers_port == 0 || (makers_baud != 0 && table.has("device"))) {
    if (table.has("host"))
      table.refuse("host", "is for " + what + "s on the network", "give the serial line of this one as device");
    wiring.device = table.text("device");
    wiring.baud = static_cast<std::uint32_t>(table.integer("baud", makers_baud));
    return wiring;
  }
  if (table.has("device"))
    table.refuse("device", "is for " + what + "s on a serial line", "give the address of this one as host");
  wiring.host = table.text("host");
  wiring.port = static_cast<std::uint16_t>(table.integer("port", makers_port));
  return wiring;
}

std::string name_of(const ByteWiring& wiring) {
  return wiring.host.empty() ? wiring.device : wiring.host + ":" + std::to_string(wiring.port);
}

}  // namespace jaywalk
