#pragma once
#include <memory>
#include <vector>

#include "firmware/run_sample.h"

namespace jaywalk {
/// Measurements of one kind: the first kMostKept as they are (22 minutes of ticks at 50 Hz), and where there are more,
/// all of them in a histogram, whose quantiles are too great by 1.6 % at most. The greatest is exact.
class Distribution {
 public:
  static constexpr std::size_t kMostKept = 65'536;

  void add(double value);
  [[nodiscard]] bool empty() const { return values_.empty() && !many_; }
  /// The smallest value that at least `share` of all do not exceed (nearest rank); share in (0, 1].
  /// NaN when there are none.
  [[nodiscard]] double quantile(double share) const;
  [[nodiscard]] double max() const { return quantile(1.0); }

 private:
  std::vector<double> values_;  ///< empty where `many_` has them
  std::unique_ptr<LogHistogram> many_;
};

}  // namespace jaywalk
