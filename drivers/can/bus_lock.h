#pragma once
#include <string>

#include "drivers/wire/file_descriptor.h"

namespace jaywalk {

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

}  // namespace jaywalk
