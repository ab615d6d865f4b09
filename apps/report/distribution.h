#pragma once
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "firmware/run_sample.h"

namespace jaywalk {
/// Measurements of one kind: the first kMostKept as they are (22 minutes of ticks at 50 Hz), and where there are more,
/// all of them in a histogram, whose quantiles are too great by 1.6 % at most. The greatest is exact.
class Distribution {
 public:
  static constexpr std::size_t kMostKept = 65'536;

  void add(double value) {
    if (many_) return many_->add(value);
    values_.push_back(value);
    if (values_.size() <= kMostKept) return;
    many_ = std::make_unique<LogHistogram>();
    for (const double kept : std::exchange(values_, {})) many_->add(kept);
  }
  /// The smallest value that at least `share` of all do not exceed (nearest rank); share in (0, 1].
  /// NaN when there are none.
  [[nodiscard]] double quantile(double share) const {
    if (many_) return many_->quantile(share);
    if (values_.empty()) return std::numeric_limits<double>::quiet_NaN();
    std::vector<double> sorted = values_;
    const double rank = std::ceil(share * static_cast<double>(sorted.size()));
    const auto at = sorted.begin() + static_cast<std::ptrdiff_t>(std::max(rank, 1.0)) - 1;
    std::nth_element(sorted.begin(), at, sorted.end());
    return *at;
  }
  [[nodiscard]] double max() const { return quantile(1.0); }

 private:
  std::vector<double> values_;  ///< empty where `many_` has them
  std::unique_ptr<LogHistogram> many_;
};

}  // namespace jaywalk
