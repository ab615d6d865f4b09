#pragma once
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace jaywalk::campaign {

inline constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();  ///< a figure of which nothing is known

struct Interval {
  double low = 0.0, high = 1.0;
};

/// 95 % interval of a share of `runs` that succeeded (Wilson 1927, z = 1.96); of no runs: 0 to 1.
[[nodiscard]] Interval wilson(std::size_t successes, std::size_t runs);

/// The middle value, the mean of both where there are two; NaN of none. NaN among them are left out.
[[nodiscard]] double median(std::vector<double> values);
/// The smallest value that at least `share` of all do not exceed (nearest rank); NaN of none. NaN are left out.
[[nodiscard]] double quantile(std::vector<double> values, double share);
/// Half of the 95 % interval of the mean of two values or more (Student's t, by Cornish and Fisher's expansion).
[[nodiscard]] double half_interval(const std::vector<double>& values);
[[nodiscard]] double mean(const std::vector<double>& values);

/// With so many digits behind the point, whatever the locale; "-" for NaN.
[[nodiscard]] std::string fixed(double value, int digits);

}  // namespace jaywalk::campaign
