#include "apps/campaign/ride.h"

#include <cmath>

#include "apps/report/csv_rows.h"

namespace jaywalk::campaign {
namespace {

constexpr double kLeastTurn_radps = 0.1, kLeastSpeed_mps = 0.03;  // slower than this it turns, or drives, neither way
constexpr double kStands_mps = 0.05;

/// How often a value larger than `least` is followed, at last, by one of the other sign.
class Reversals {
 public:
  explicit Reversals(double least) : least_(least) {}
  void add(double value) {
    if (!(std::fabs(value) > least_)) return;
    const int sign = value > 0.0 ? 1 : -1;
    if (sign == -sign_) ++count_;
    sign_ = sign;
  }
  [[nodiscard]] double count() const { return count_; }

 private:
  double least_, count_ = 0.0;
  int sign_ = 0;
};

}  // namespace

Ride ride_of(const std::filesystem::path& robot_csv) {
  CsvRows rows(robot_csv, {"v_mps", "w_radps"});
  Reversals steering(kLeastTurn_radps), speed(kLeastSpeed_mps);
  double ticks = 0.0, stood = 0.0;
  for (; rows.next(); ++ticks) {
    const double v_mps = rows.number(0);
    steering.add(rows.number(1));
    speed.add(v_mps);
    if (std::fabs(v_mps) < kStands_mps) ++stood;
  }
  return {steering.count(), speed.count(), ticks > 0.0 ? stood / ticks : 0.0};
}

}  // namespace jaywalk::campaign
