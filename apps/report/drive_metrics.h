#pragma once
// Metrics of a run: path, smoothness, loops, detours, and share granted to a person's stick; and a run in words.
#include <algorithm>
#include <array>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "apps/report/distribution.h"
#include "firmware/recording/tick_record.h"
#include "hal/types/geometry.h"
#include "hal/types/time.h"

namespace jaywalk {

inline constexpr double kTurnStepM = 0.25;
inline constexpr std::size_t kTurnBins = 18;
inline constexpr double kTurnBinDeg = 10.0;

/// Length and turning angles of a driven path.
///
/// A mark is set every kTurnStepM of travel along the path; the turning angle at a mark is the one,
/// in [0, 180] degrees, between the straight lines from the mark before and to the mark after. Bin i
/// of the histogram counts those in [10 i, 10 (i + 1)) degrees, the last one 180 as well.
class PathShape {
 public:
  void add(Vec2 position);
  [[nodiscard]] double length_m() const { return length_m_; }
  [[nodiscard]] double max_turn_deg() const { return max_turn_deg_; }
  [[nodiscard]] const std::array<std::uint32_t, kTurnBins>& turn_histogram() const { return histogram_; }

 private:
  void mark(Vec2 position);

  std::optional<Vec2> newest_;
  Vec2 last_mark_;
  double since_mark_m_ = 0.0;      ///< travel from the last mark to `newest_`
  std::optional<Vec2> last_step_;  ///< from the last mark but one to the last
  double length_m_ = 0.0;
  double max_turn_deg_ = 0.0;
  std::array<std::uint32_t, kTurnBins> histogram_{};
};

/// Acceleration and jerk from samples of speed. Each is the change over the last kWindow, so that a
/// speed that comes in small steps does not read as violent: a(t) = (v(t) - v(t - window)) / window,
/// and jerk likewise from a.
class Smoothness {
 public:
  static constexpr Duration kWindow{100'000'000};

  void add(Time t, double speed_mps);
  /// Greatest magnitude; NaN before the first window is full.
  [[nodiscard]] double accel_max_mps2() const { return accel_.max(); }
  [[nodiscard]] double jerk_quantile_mps3(double share) const { return jerk_.quantile(share); }

 private:
  struct Sample {
    Time t;
    double speed_mps = 0.0;
    std::optional<double> accel_mps2 = {};
  };
  std::deque<Sample> samples_;  ///< the first is the youngest that is at least kWindow old
  Distribution accel_, jerk_;
};

struct Episode {
  double from_s = 0.0, to_s = 0.0;
};

/// A loop is a net turn by 340 degrees within 10 m of way, whatever the plan was meanwhile and however long it took. On
/// a longer way a turn may be the way itself, as on map 4, where an alley ends and another leads on.
class LoopCount {
 public:
  /// A new goal begins anew: a turn back to another goal is none.
  void add(double t_s, const Pose2& pose, Vec2 goal);
  [[nodiscard]] const std::vector<Episode>& loops() const { return loops_; }

 private:
  /// Turns, rad, while the way grew by kPiece_m: at the least and at the most, and when these were.
  struct Piece {
    double way_m, least_rad, most_rad, least_s, most_s;
  };
  /// The last moment since which the robot has turned by a loop; NaN: there is none.
  [[nodiscard]] double loop_since_s() const;

  std::optional<Pose2> last_;
  Vec2 goal_;
  double way_m_ = 0.0, turned_rad_ = 0.0;
  std::deque<Piece> pieces_;  ///< of the last 10 m
  std::vector<Episode> loops_;
};

/// Judges each 3 m of way: what is above 1.5 times the fall of the way to go is a detour. Detours side by side are one.
class DetourCount {
 public:
  /// `to_go_m`: time to go by the controller's plan, at full speed; infinite where no way is known.
  void add(double t_s, Vec2 position, Vec2 goal, double to_go_m);
  [[nodiscard]] const std::vector<Episode>& detours() const { return detours_; }
  /// Way above 1.5 times the fall, m, of all of them.
  [[nodiscard]] double detour_m() const { return detour_m_; }

 private:
  static constexpr double kStretch_m = 3.0, kFair = 1.5;
  void judge(double t_s, double to_go_m);

  bool begun_ = false;
  Vec2 last_, goal_;
  double from_s_ = 0.0, way_m_ = 0.0, from_to_go_m_ = 0.0;  ///< of the stretch
  double detour_m_ = 0.0;
  std::vector<Episode> detours_;
};

/// How much of what a person's stick asked for was permitted.
class GrantedShare {
 public:
  void add(const TickRecord& t) noexcept {
    if (last_ != kNever && steered_) steered_s_ += to_seconds(t.now - last_);
    last_ = t.now, steered_ = t.input.steers;
    if (t.wished == Twist2{}) return;
    sum_ += share_of(t.wished, t.verdict.permitted);
    ++ticks_;
  }
  /// Over all ticks with a stick out of its middle, 0 to 1; NaN without one.
  [[nodiscard]] double mean() const noexcept {
    return ticks_ == 0 ? std::numeric_limits<double>::quiet_NaN() : sum_ / static_cast<double>(ticks_);
  }
  [[nodiscard]] double steered_s() const noexcept { return steered_s_; }

  /// The permitted twist's part along the wished one, 0 to 1; a rad/s counts as half a m/s.
  [[nodiscard]] static double share_of(const Twist2& wished, const Twist2& permitted) noexcept {
    constexpr double kArm2_m2 = 0.25;
    const double along = permitted.v_mps * wished.v_mps + kArm2_m2 * permitted.w_radps * wished.w_radps;
    const double whole = wished.v_mps * wished.v_mps + kArm2_m2 * wished.w_radps * wished.w_radps;
    return std::clamp(along / whole, 0.0, 1.0);
  }

 private:
  double sum_ = 0.0, steered_s_ = 0.0;
  std::uint64_t ticks_ = 0;
  bool steered_ = false;
  Time last_ = kNever;
};

/// Plain words about the run in `folder`: distance, time driven, time stood with its causes, faults. A killed run has
/// no summary.json; its tables are described all the same. Throws StartupError where robot.csv is missing or has a row
/// of another form.
[[nodiscard]] std::string run_words(const std::filesystem::path& folder);

}  // namespace jaywalk
