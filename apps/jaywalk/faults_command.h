#pragma once
#include <filesystem>

namespace jaywalk {

struct FaultsOptions {
  std::filesystem::path out = "out/faults";
  double rate_hz = 50.0;  ///< of the control loop
};

/// The fault matrix on the simulated robot: prints it, and leaves faults.csv in the folder (docs/reference/outputs.md).
/// Returns 0 where every row is ok, else 1. Throws StartupError.
[[nodiscard]] int run_faults(const FaultsOptions& options);

}  // namespace jaywalk
