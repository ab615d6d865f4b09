#pragma once
#include <unistd.h>

#include <filesystem>
#include <iostream>
#include <memory>
#include <string>

#include "hal/types/errors.h"
#include "hil/emulators/byte_server.h"

namespace jaywalk::tests {

/// The device's end of a serial line that no other test has; none, and "skipped", where there are no pseudo terminals.
inline std::unique_ptr<emulators::PtyServer> serial_line() {
  static int lines = 0;
  const std::string name = "jaywalk_line_" + std::to_string(::getpid()) + "_" + std::to_string(++lines);
  try {
    return std::make_unique<emulators::PtyServer>((std::filesystem::temp_directory_path() / name).string());
  } catch (const StartupError& error) {
    std::cout << "skipped: " << error.what() << "\n";
    return nullptr;
  }
}

}  // namespace jaywalk::tests
