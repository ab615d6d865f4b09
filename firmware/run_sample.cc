#include "firmware/run_sample.h"

#include <algorithm>
#include <cmath>

namespace jaywalk {

/// frexp: value = mantissa * 2^exponent, mantissa in [0.5, 1): exact, whatever the machine.
std::size_t LogHistogram::bin_of(double value) noexcept {
  if (!(value >= std::ldexp(1.0, kLowest))) return 0;
  if (value >= std::ldexp(1.0, kHighest)) return kBins - 1;
  int exponent = 0;
  const double mantissa = std::frexp(value, &exponent);
  const auto within = static_cast<std::size_t>((mantissa - 0.5) * 2.0 * kPerDoubling);
  return 1 + static_cast<std::size_t>(exponent - 1 - kLowest) * kPerDoubling + within;
}

double LogHistogram::upper_edge(std::size_t bin) noexcept {
  if (bin == 0) return 0.0;
  const auto doubling = static_cast<int>((bin - 1) / kPerDoubling);
  const auto within = static_cast<double>((bin - 1) % kPerDoubling + 1);
  return std::ldexp(1.0 + within / kPerDoubling, kLowest + doubling);
}

void LogHistogram::add(double value) noexcept {
  max_ = count_ == 0 ? value : std::max(max_, value);
  ++count_;
  ++bins_[bin_of(value)];
}

double LogHistogram::quantile(double share) const noexcept {
  if (count_ == 0) return std::numeric_limits<double>::quiet_NaN();
  const double rank = std::max(std::ceil(share * static_cast<double>(count_)), 1.0);
  std::uint64_t below = 0;
  for (std::size_t bin = 0; bin < kBins - 1; ++bin) {
    below += bins_[bin];
    if (static_cast<double>(below) >= rank) return std::min(upper_edge(bin), max_);
  }
  return max_;
}

std::vector<std::pair<double, std::uint64_t>> LogHistogram::doublings() const {
  std::vector<std::pair<double, std::uint64_t>> found;
  if (bins_[0] > 0) found.emplace_back(0.0, bins_[0]);
  for (std::size_t first = 1; first < kBins; first += kPerDoubling) {
    std::uint64_t count = 0;
    for (std::size_t bin = first; bin < first + kPerDoubling; ++bin) count += bins_[bin];
    if (count > 0) found.emplace_back(upper_edge(first + kPerDoubling - 1), count);
  }
  return found;
}

}  // namespace jaywalk
