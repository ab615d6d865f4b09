#pragma once
#include <filesystem>
#include <optional>

#include "firmware/control_setup.h"

namespace jaywalk {

struct FieldOptions {
  std::filesystem::path map;     ///< .yaml (map_server), .map (ARIA), .txt (cylinders), .png or .pgm
  std::optional<Vec2> goal;      ///< in the map; default: the free cell nearest its middle
  double inflation_m = 0.3;      ///< walls grow by this
  std::optional<double> cell_m;  ///< of a picture without a YAML file, or of what has no cells (default there: 0.1 m)
  Backend backend = Backend::kAuto;
  int device = 0;           ///< CUDA's number
  bool start_only = false;  ///< the start field alone: shortest ways, no potential solved
  std::filesystem::path out = "out/field";
};

/// The potential of a map alone, as field.npy and field.json. Returns 0 when it is certified, 1 when not. Throws
/// StartupError for bad input.
[[nodiscard]] int run_field(const FieldOptions& options);

}  // namespace jaywalk
