#include "apps/report/distribution.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace jaywalk {
void Distribution::add(double value) {
  if (many_) return many_->add(value);
  values_.push_back(value);
  if (values_.size() <= kMostKept) return;
  many_ = std::make_unique<LogHistogram>();
  for (const double kept : std::exchange(values_, {})) many_->add(kept);
}

double Distribution::quantile(double share) const {
  if (many_) return many_->quantile(share);
  if (values_.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::vector<double> sorted = values_;
  const double rank = std::ceil(share * static_cast<double>(sorted.size()));
  const auto at = sorted.begin() + static_cast<std::ptrdiff_t>(std::max(rank, 1.0)) - 1;
  std::nth_element(sorted.begin(), at, sorted.end());
  return *at;
}

}  // namespace jaywalk
