#include "planner/field/start_field.h"

#include <cmath>

#include "hal/types/trig.h"

namespace jaywalk::field {

std::vector<std::uint16_t> rate_table(std::int32_t max_side) {
  std::vector<std::uint16_t> table(static_cast<std::size_t>(4 * (max_side + 4)));
  for (std::size_t quarter = 0; quarter < table.size(); ++quarter) {
    const double width = static_cast<double>(quarter) / 4.0;
    const double cosh_rate = 2.0 - cos(kPi / (width + 1.0));
    const double rate = log(cosh_rate + std::sqrt(cosh_rate * cosh_rate - 1.0));
    table[quarter] = static_cast<std::uint16_t>(std::floor(rate / 2.0 * static_cast<double>(kCostsPerPsi) + 0.5));
  }
  return table;
}

}  // namespace jaywalk::field
