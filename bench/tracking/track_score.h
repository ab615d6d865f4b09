#pragma once
// Scores of tracks: the CLEAR MOT figures (Bernardin and Stiefelhagen 2008), velocities, false movers, how soon a mover
// is found, and whether tracks are as sure as they have a right to be (Bar-Shalom et al. 2001, section 5.4). Scores of
// poses.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <set>
#include <span>
#include <vector>

#include "hal/types/geometry.h"
#include "planner/tracking/track.h"

namespace jaywalk::bench {
inline constexpr double kWithin95 = 5.991;  ///< chi-squared, two degrees of freedom: -2 ln 0.05

/// NaN of nothing.
[[nodiscard]] inline double share_of(std::size_t part, std::size_t whole) {
  return whole == 0 ? std::numeric_limits<double>::quiet_NaN() : static_cast<double>(part) / static_cast<double>(whole);
}

/// Innovations of tracks that move, each squared and divided by the covariance that the filter gave it: chi-squared
/// with two degrees of freedom where the filter is honest, mean 2, 95 in 100 below 5.99. Less: it doubts too much.
class Innovations {
 public:
  /// The tracks after each scan, in the order of time. Those that move, were there before and were seen again tell
  /// theirs (Track::surprise).
  void add(std::span<const Track> tracks);

  [[nodiscard]] std::size_t count() const { return count_; }
  /// NaN without any, as the next.
  [[nodiscard]] double mean() const { return sum_ / static_cast<double>(count_); }
  /// How far from 2 the mean of so many independent ones stays in 95 of 100 cases.
  [[nodiscard]] double mean_bound() const { return 1.96 * 2.0 / std::sqrt(static_cast<double>(count_)); }
  [[nodiscard]] double share_within_95() const { return share_of(within_, count_); }

 private:
  std::map<std::uint32_t, std::uint32_t> hits_before_;  ///< of each track
  std::size_t count_ = 0, within_ = 0;
  double sum_ = 0.0;
};

/// Innovations of the tracker over a simulation's recording, which is lived through again without plans: perception
/// does not depend on them. Empty for a recording of mode paper, which is given its movers. Throws StartupError.
[[nodiscard]] Innovations innovations_of(const std::filesystem::path& recording);

/// Somebody who is really there.
struct Target {
  std::uint32_t id = 0;
  Vec2 position_in_map;  ///< m
  Vec2 velocity_in_map;  ///< m/s; NaN: not known
  bool in_view = true;   ///< false: finding it is neither right nor wrong

  /// Known to stand: it turns on the spot, or waits.
  [[nodiscard]] bool stands() const { return velocity_in_map == Vec2{}; }
};

/// A track of the controller's.
struct Hypothesis {
  std::uint32_t id = 0;
  Vec2 position_in_map;
  Vec2 velocity_in_map;
  bool moving = true;  ///< false: it may find a target, and is no error where it finds none
  double std_m = std::numeric_limits<double>::quiet_NaN();  ///< of the position, an axis; NaN: not told
};

struct ScoreRules {
  double match_m = 0.5;          ///< a hypothesis this near a target may be its
  double settled_after_s = 1.0;  ///< velocities are compared once a track is this old
  double kept_s = 1.0;           ///< a name is to be kept through so long unfound
  double steady_mps = 0.3;  ///< a velocity farther off is wrong, of a target that has kept its own for settled_after_s
  double soon_s = 0.6;      ///< a target is found soon when it has moved in view for no longer until then
  bool as_it_is = false;    ///< a track that stands may find only a target that stands
};

/// Adds up frame by frame. Pairs of the frame before stay pairs while they are near enough; the rest pair up nearest
/// first.
class TrackScore {
 public:
  explicit TrackScore(const ScoreRules& rules) : rules_(rules) {}

  /// Frames come in the order of time. Every id stands once in a frame.
  void add(double t_s, std::span<const Target> targets, std::span<const Hypothesis> tracks);

  [[nodiscard]] std::size_t targets() const { return targets_; }
  [[nodiscard]] std::size_t matches() const { return matches_; }
  [[nodiscard]] std::size_t misses() const { return targets_ - matches_; }
  [[nodiscard]] std::size_t false_positives() const { return false_positives_; }
  [[nodiscard]] std::size_t switches() const { return switches_; }
  /// Those of them that no long absence explains: the target had been found at most kept_s before.
  [[nodiscard]] std::size_t quick_switches() const { return quick_switches_; }
  /// 1 - (misses + false positives + switches) / targets; NaN without targets.
  [[nodiscard]] double mota() const { return 1.0 - share_of(misses() + false_positives_ + switches_, targets_); }
  /// Mean distance of matched pairs, m; NaN without any.
  [[nodiscard]] double motp_m() const { return distance_sum_m_ / static_cast<double>(matches_); }
  /// Root of the mean squared length of the velocity's error, m/s; NaN where nothing could be compared.
  [[nodiscard]] double velocity_rmse_mps() const {
    return std::sqrt(velocity_error2_sum_ / static_cast<double>(compared_));
  }
  /// Of targets that kept their velocity, how many of the compared ones were wrong (ScoreRules::steady_mps); NaN: none.
  [[nodiscard]] double steady_wrong() const { return share_of(steady_wrong_, steady_compared_); }
  /// Share of their positions within the 95 % bound of what the tracks claim; NaN where none claims anything.
  [[nodiscard]] double covered() const { return share_of(covered_, claimed_); }
  /// Tracks that moved and never were anybody's.
  [[nodiscard]] std::size_t false_movers() const;
  /// Share of the times a target moved in view, having come there, that it was found soon; NaN where none did. While it
  /// is hidden, or stands, no time counts.
  [[nodiscard]] double found_soon() const { return soon_.share(); }
  /// The same with all time counted from when it first moved in view.
  [[nodiscard]] double found_soon_by_clock() const { return soon_by_clock_.share(); }

 private:
  struct Pair {
    std::size_t target = 0, track = 0;
    double distance_m = 0.0;
  };
  /// Since when a target has kept its velocity.
  struct Steady {
    double since_s = 0.0;
    Vec2 velocity_in_map;
  };
  /// How often something was in time, of all times that it was decided.
  struct InTime {
    std::size_t decided = 0, in_time = 0;
    /// Decides `open` where `found`, or where the time is over; who leaves before either tells nothing.
    void note(bool found, bool over, bool& open);
    [[nodiscard]] double share() const { return share_of(in_time, decided); }
  };
  /// A stay in view.
  struct Stay {
    double since_s = 0.0, last_s = 0.0, moved_s = 0.0;
    bool open = true, open_by_clock = true;
  };
  void pair_up(std::span<const Target> targets, std::span<const Hypothesis> tracks);
  void count(double t_s, const Target& target, const Hypothesis& track, double distance_m);
  void note_steady(double t_s, const Target& target);
  void compare_steady(double t_s, const Target& target, const Hypothesis& track, double distance_m);
  void note_stay(double t_s, const Target& target, bool found);

  ScoreRules rules_;
  std::vector<Pair> pairs_;
  std::map<std::uint32_t, std::uint32_t> track_of_;  ///< of each target, the track it was last found by
  std::map<std::uint32_t, double> found_s_;          ///< of each target, when
  std::map<std::uint32_t, double> born_s_;           ///< of each track
  std::map<std::uint32_t, Stay> stays_;
  std::map<std::uint32_t, Steady> steady_;
  std::set<std::uint32_t> moved_, right_;  ///< tracks that moved; that were somebody's
  std::size_t targets_ = 0, matches_ = 0, false_positives_ = 0, switches_ = 0, quick_switches_ = 0;
  std::size_t compared_ = 0, steady_compared_ = 0, steady_wrong_ = 0, claimed_ = 0, covered_ = 0;
  InTime soon_, soon_by_clock_;
  double frame_before_s_ = 0.0;
  double distance_sum_m_ = 0.0, velocity_error2_sum_ = 0.0;
};

/// Two beliefs of where the robot was at the same moment, each in a frame of its own.
struct PosePair {
  Pose2 estimate, truth;
};

/// Medians over all stretches of the given length. NaN where the drive was shorter.
struct RelativeError {
  std::size_t stretches = 0;
  double translation_percent = 0.0;  ///< of the stretch's length
  double heading_deg = 0.0;
};

/// By how much the estimate's motion differs from the true one over stretches of `length_m` of the true way, one
/// beginning every `every_m` (relative pose error: Sturm et al. 2012, over distance as Geiger et al. 2012). Ways are
/// measured from place to place at least 5 cm apart, so that a standing robot's noise is no way.
[[nodiscard]] RelativeError relative_error(const std::vector<PosePair>& drive, double length_m, double every_m);

/// From a pair to the next: by how much the estimate's motion differs from the true one at most.
struct StepError {
  double translation_m = 0.0, heading_deg = 0.0;
};
[[nodiscard]] StepError greatest_step_error(const std::vector<PosePair>& drive);

}  // namespace jaywalk::bench
