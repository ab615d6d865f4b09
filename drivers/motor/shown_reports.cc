#include "drivers/motor/shown_reports.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace jaywalk {

namespace {

constexpr Duration kShownFor = std::chrono::milliseconds(500);
constexpr int kReportsShown = 10;          // of the period stated, in a proof
constexpr double kShareShown = 0.8;        // of those that its period promises
constexpr double kLongestReport_s = 0.25;  // report_ms

}  // namespace

Duration ShownReports::shown_for() const noexcept {
  return std::max(kShownFor, duration_from_seconds(kReportsShown * times_.report_s));
}

void ShownReports::begin(Time now) noexcept {
  *this = ShownReports(times_, tick_);
  began_ = now;
}

void ShownReports::note(Time now, double speed_radps) noexcept {
  if (++readings_ > 1) longest_ = std::max(longest_, now - read_);
  read_ = now;
  fastest_radps_ = std::fmax(fastest_radps_, std::fabs(speed_radps));
}

bool ShownReports::is_often_enough() const noexcept {
  const double stated = to_seconds(shown_for()) / times_.report_s;
  return readings_ >= std::floor(kShareShown * stated) &&
         longest_ <= duration_from_seconds(times_.oldest_report_s()) + tick_;
}

double ShownReports::per_second() const noexcept { return readings_ / to_seconds(shown_for()); }

std::string ShownReports::remedy() const {
  const double report_s = to_seconds(shown_for()) / std::max(readings_, 1);
  const double late_s = std::max(to_seconds(longest_) - report_s, 0.0);
  std::array<char, 200> text{};
  std::snprintf(text.data(), text.size(),
                report_s <= kLongestReport_s
                    ? "write report_ms = %.0f and report_late_ms = %.0f in [drive], or have it published more often"
                    : "have it published at least 4 times a second (now every %.0f ms, up to %.0f ms late)",
                std::ceil(1e3 * report_s), 10.0 * std::ceil(100.0 * late_s));
  return text.data();
}

}  // namespace jaywalk
