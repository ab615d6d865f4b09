#pragma once
// What a report is told after each tick, and at the end.
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "firmware/recording/tick_record.h"
#include "hal/types/geometry.h"
#include "hal/types/social_measures.h"
#include "hal/types/time.h"
#include "planner/cost_to_go/planner.h"
#include "planner/tracking/track.h"

namespace jaywalk {

/// Counts of measurements: 64 bins for each doubling, 0.8 to 1.6 % wide, from 2^-20 (a millionth) to 2^20; what is less
/// counts as 0, what is more in the last bin. The greatest is kept as it is. Adding neither allocates nor throws.
class LogHistogram {
 public:
  void add(double value) noexcept;
  [[nodiscard]] std::uint64_t count() const noexcept { return count_; }
  [[nodiscard]] double max() const noexcept { return max_; }
  /// The upper edge of the bin that holds the smallest value that at least `share` of all do not exceed (nearest rank),
  /// the greatest value at most: too great by 1.6 % at most. NaN when there are none.
  [[nodiscard]] double quantile(double share) const noexcept;
  /// Upper edge and count of each doubling that holds any; the first is 0 where values were below 2^-20.
  [[nodiscard]] std::vector<std::pair<double, std::uint64_t>> doublings() const;

 private:
  static constexpr int kLowest = -20, kHighest = 20, kPerDoubling = 64;
  static constexpr std::size_t kBins = static_cast<std::size_t>(kHighest - kLowest) * kPerDoubling + 1;
  [[nodiscard]] static std::size_t bin_of(double value) noexcept;
  [[nodiscard]] static double upper_edge(std::size_t bin) noexcept;

  std::array<std::uint64_t, kBins> bins_{};  ///< the first: what counts as 0
  std::uint64_t count_ = 0;
  double max_ = 0.0;
};

/// How well a loop with a thread of its own kept time, from its first tick on.
struct LoopTimes {
  LogHistogram wake_late_us;  ///< from when a tick was due to when the thread woke
  LogHistogram tick_us;       ///< from waking to the end of the tick, the status and the trace included
  std::uint64_t minor_faults = 0, major_faults = 0;  ///< page faults of that thread; major: the disk was waited for
};

class ControlLoop;

struct TrueMover {
  std::uint32_t id = 0;
  Vec2 position_in_map;
  Vec2 velocity_in_map;
  double radius_m = 0.0;
  bool forced = false;
};

/// What is really so at the tick: a simulation knows, a robot does not. Counts are so far.
struct TrueState {
  Pose2 map_from_robot;
  Twist2 twist;
  std::span<const TrueMover> movers;
  double clearance_m = std::numeric_limits<double>::infinity();        ///< footprint to anything; 0 in contact
  double mover_clearance_m = std::numeric_limits<double>::infinity();  ///< footprint to the nearest mover
  std::uint32_t contacts = 0;
  std::uint32_t contacts_caused = 0;
  std::uint32_t forced_movers = 0;
  SocialMeasures social = {};
};

/// One tick, seen from outside the loop. Everything referred to outlives the call only.
struct RunSample {
  const TickRecord& record;
  std::span<const Track> tracks = {};      ///< as the controller believes after this tick
  const TrueState* truth = nullptr;        ///< null in a replay
  Duration tick_took{0};                   ///< measured
  std::optional<PlanTook> plan_took = {};  ///< when this tick collected a new plan: what it took
  Time now = record.now;  ///< as tables are to say it, here and below: a recording may have a clock of its own
  Time scanned = record.newest_scan().stamp;  ///< the scan's
  const ControlLoop* loop = nullptr;          ///< where the loop's own thread reports, else null
  const Planner* planner = nullptr;           ///< the same
};

/// How it ended and under which conditions: what summary.json says, a field a key, so more of them than elsewhere.
struct RunEnd {
  std::string outcome = {};  ///< reached, collision, forced_mover, timeout, fault; "replayed" for a replay
  bool success = false;
  std::optional<double> static_shortest_path_m = {};
  std::optional<double> heading_error_rad = {};     ///< at the end, where a heading was wanted at the goal
  std::optional<double> found_mount_yaw_rad = {};   ///< of the laser, where a replay found it by matching
  std::optional<double> found_clock_offset_s = {};  ///< of its odometry, found by its turns
  std::uint64_t missed_ticks = 0;
  std::uint64_t dropped_records = 0;
  std::vector<std::string> not_recorded = {};  ///< what the disk did not take beside the tables, a line each
  const LoopTimes* loop_times = nullptr;       ///< of a robot's loop; null elsewhere
  std::string backend = {};
  std::string mode = {};
  std::optional<std::uint64_t> seed = {};
  std::string scenario = {};
  std::vector<std::string> settings = {};  ///< KEY=VALUE each, given in place of the scenario's own
  std::string version = {};
  std::string planner = {};              ///< empty but in a simulation
  std::string mover_rule = {};           ///< empty where no wandering rule was in force
  std::string title = {};                ///< of the picture
  std::filesystem::path recording = {};  ///< where one was made, whole; else empty
};

struct ControlSetup;

/// How loop and robot tell the rest of the world: tables, pictures, MCAP and live page implement this in apps.
class TickObserver {
 public:
  virtual ~TickObserver() = default;

  /// Before the first tick. `tables`: where what grows goes, `out` or its first part. Throws StartupError.
  virtual void begin(const std::filesystem::path& /*out*/, const std::filesystem::path& /*tables*/,
                     const ControlSetup& /*setup*/) {}

  /// Loop's thread, after each tick: copies what it wants; neither allocates nor waits.
  virtual void after_tick(const TickRecord& /*record*/, const ControlLoop& /*loop*/) noexcept {}
  /// Planner's thread, after each plan, which was made with `map`. The same limits.
  virtual void after_plan(const Planner& /*planner*/, const EvidenceMap& /*map*/, Time /*stamp*/) noexcept {}

  /// This and all functions below: the reporting thread; they may be slow. Called once for each tick that was kept.
  virtual void report(const RunSample& /*sample*/) {}
  /// Called about 50 times a second on a robot, also when no tick came.
  virtual void follow() {}
  /// Rows of ticks later than `last` go to the folder `part`. Throws StartupError where it cannot be made.
  virtual void continue_in(const std::filesystem::path& /*part*/, Time /*last*/) {}
  virtual void end_tables() {}
  [[nodiscard]] virtual std::uintmax_t bytes() const { return 0; }
  /// One line for each file that the disk did not take whole.
  [[nodiscard]] virtual std::vector<std::string> complaints() const { return {}; }
  [[nodiscard]] virtual bool is_losing() const { return false; }
  /// Once, after the last tick. Returns the file to look at first; empty: the run's folder. Throws StartupError.
  virtual std::filesystem::path finish(const RunEnd& /*end*/, const ControlLoop& /*loop*/, const Planner& /*planner*/) {
    return {};
  }
};

}  // namespace jaywalk
