#include "firmware/report/distribution.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace jaywalk {

double Distribution::quantile(double share) const {
  if (values_.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::vector<double> sorted = values_;
  const double rank = std::ceil(share * static_cast<double>(sorted.size()));
  const auto at = sorted.begin() + static_cast<std::ptrdiff_t>(std::max(rank, 1.0)) - 1;
  std::nth_element(sorted.begin(), at, sorted.end());
  return *at;
}

}  // namespace jaywalk
