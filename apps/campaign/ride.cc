#include "apps/campaign/ride.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "apps/report/csv_file.h"
#include "apps/report/distribution.h"

namespace jaywalk::campaign {
namespace {

constexpr double kLeastTurn_radps = 0.1, kLeastSpeed_mps = 0.03;  // slower than this it turns, or drives, neither way
constexpr double kStands_mps = 0.05;
constexpr double kChangeOver_s = 0.0999, kBrakeEnds_s = 0.3;  // a brake that bites again sooner is the same
constexpr double kBesideBrake_s = 0.25;                       // its onset and release are its own

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

/// Hard brakes, and the jerk apart from them.
class Brakes {
 public:
  void add(double t_s, double v_mps) {
    while (first_ + 1 < samples_.size() && t_s - samples_[first_ + 1].t_s >= kChangeOver_s) ++first_;
    Sample now{t_s, std::fabs(v_mps)};
    if (!samples_.empty() && t_s - samples_[first_].t_s >= kChangeOver_s) {
      const Sample& before = samples_[first_];
      now.accel = (now.speed - before.speed) / (t_s - before.t_s);
      now.jerk = std::fabs(now.accel - before.accel) / (t_s - before.t_s);
      if (now.accel < -kHardBrake_mps2) note_brake(t_s);
    }
    samples_.push_back(now);
  }
  [[nodiscard]] double count() const { return static_cast<double>(brakes_.size()); }
  [[nodiscard]] double calm_jerk(double share) const {
    Distribution calm;
    for (const Sample& sample : samples_)
      if (!std::isnan(sample.jerk) && !is_beside_brake(sample.t_s)) calm.add(sample.jerk);
    return calm.quantile(share);
  }

 private:
  struct Sample {
    double t_s, speed, accel = std::nan(""), jerk = std::nan("");
  };
  void note_brake(double t_s) {
    if (brakes_.empty() || t_s - brakes_.back().second > kBrakeEnds_s) brakes_.emplace_back(t_s, t_s);
    brakes_.back().second = t_s;
  }
  [[nodiscard]] bool is_beside_brake(double t_s) const {
    return std::ranges::any_of(brakes_, [t_s](const auto& brake) {
      return t_s > brake.first - kBesideBrake_s && t_s < brake.second + kBesideBrake_s;
    });
  }

  std::vector<Sample> samples_;
  std::size_t first_ = 0;                            ///< the youngest at least kChangeOver_s old
  std::vector<std::pair<double, double>> brakes_{};  ///< from, to, s
};

}  // namespace

Ride ride_of(const std::filesystem::path& robot_csv) {
  CsvRows rows(robot_csv, {"v_mps", "w_radps", "t_s"});
  Reversals steering(kLeastTurn_radps), speed(kLeastSpeed_mps);
  Brakes brakes;
  double ticks = 0.0, stood = 0.0;
  for (; rows.next(); ++ticks) {
    const double v_mps = rows.number(0);
    steering.add(rows.number(1));
    speed.add(v_mps);
    brakes.add(rows.number(2), v_mps);
    if (std::fabs(v_mps) < kStands_mps) ++stood;
  }
  return {steering.count(), speed.count(), ticks > 0.0 ? stood / ticks : 0.0, brakes.count(), brakes.calm_jerk(0.99)};
}

}  // namespace jaywalk::campaign
