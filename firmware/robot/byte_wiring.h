#pragma once
// Serial line or TCP port of a device, as a robot file gives it.
#include <cstdint>
#include <string>

#include "hal/toml_file.h"

namespace jaywalk {

struct ByteWiring {
  std::string host;  ///< empty: on a serial line
  std::uint16_t port = 0;
  std::string device;
  std::uint32_t baud = 0;
};

/// Reads host and port, or device and baud; a maker's port or baud of 0: none of its devices has that. `what`:
/// "scanner". Throws StartupError.
[[nodiscard]] ByteWiring read_byte_wiring(TomlTable& table, const std::string& what, std::uint16_t makers_port,
                                          std::uint32_t makers_baud);

/// "/dev/ttyUSB0", "192.168.0.1:8101".
[[nodiscard]] std::string name_of(const ByteWiring& wiring);

}  // namespace jaywalk
