#pragma once
#include <vector>

namespace jaywalk {

/// Measurements of one kind, kept until their quantiles are asked for.
class Distribution {
 public:
  void add(double value) { values_.push_back(value); }
  [[nodiscard]] bool empty() const { return values_.empty(); }
  /// The smallest value that at least `share` of all do not exceed (nearest rank); share in (0, 1].
  /// NaN when there are none.
  [[nodiscard]] double quantile(double share) const;
  [[nodiscard]] double max() const { return quantile(1.0); }

 private:
  std::vector<double> values_;
};

}  // namespace jaywalk
