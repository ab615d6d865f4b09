#pragma once
#include <string>

#include "apps/setup/calibration.h"

namespace jaywalk {

/// The residuals of each motion, as believed and as found: x and y (mm) and turns (mrad). An SVG without a script.
[[nodiscard]] std::string svg_of(const Calibration& calibration);

}  // namespace jaywalk
