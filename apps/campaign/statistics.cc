#include "apps/campaign/statistics.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace jaywalk::campaign {
namespace {

std::vector<double> sorted(std::vector<double> values) {
  std::erase_if(values, [](double value) { return std::isnan(value); });
  std::sort(values.begin(), values.end());
  return values;
}

}  // namespace

Interval wilson(std::size_t successes, std::size_t runs) {
  if (runs == 0) return {};
  constexpr double z = 1.96;
  const auto s = static_cast<double>(successes), n = static_cast<double>(runs);
  const double centre = (s + z * z / 2.0) / (n + z * z);
  const double half = z / (n + z * z) * std::sqrt(s * (n - s) / n + z * z / 4.0);
  return {std::max(0.0, centre - half), std::min(1.0, centre + half)};
}

double median(std::vector<double> values) {
  values = sorted(std::move(values));
  if (values.empty()) return kUnknown;
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : (values[middle - 1] + values[middle]) / 2.0;
}

double quantile(std::vector<double> values, double share) {
  values = sorted(std::move(values));
  if (values.empty()) return kUnknown;
  const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(values.size())));
  return values[std::clamp<std::size_t>(rank, 1, values.size()) - 1];
}

double half_interval(const std::vector<double>& values) {
  constexpr double z = 1.96;
  const double n = static_cast<double>(values.size()), middle = mean(values), free = n - 1.0;
  double squares = 0.0;
  for (const double value : values) squares += (value - middle) * (value - middle);
  const double t = z + (z * z * z + z) / (4.0 * free) +
                   (5.0 * std::pow(z, 5) + 16.0 * std::pow(z, 3) + 3.0 * z) / (96.0 * free * free);
  return t * std::sqrt(squares / free / n);
}

double mean(const std::vector<double>& values) {
  double sum = 0.0, count = 0.0;
  for (const double value : values)
    if (!std::isnan(value)) sum += value, ++count;
  return count > 0.0 ? sum / count : kUnknown;
}

std::string fixed(double value, int digits) {
  if (std::isnan(value)) return "-";
  char text[400];
  const auto end = std::to_chars(text, text + sizeof text, value, std::chars_format::fixed, digits).ptr;
  return {text, end};
}

}  // namespace jaywalk::campaign
