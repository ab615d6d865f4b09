#pragma once
#include <algorithm>
#include <filesystem>
#include <functional>
#include <span>
#include <vector>

#include "firmware/safety/reasons.h"
#include "hal/types/time.h"
#include "hil/far_end/simulated_robot.h"
#include "planner/cost_to_go/planner.h"

namespace jaywalk::faults {

/// Plans a straight line to the goal, a point every decimetre. The matrix measures what stops a robot, in a hall where
/// nothing is in the way; the grid planner would answer the same at a hundred times the price.
class StraightPlanner final : public Planner {
 public:
  void submit(const PlanRequest& request) noexcept override {
    if (ended_) return;
    plan_.stamp = request.stamp;
    ++plan_.sequence;
    plan_.status = PlanStatus::kOk;
    plan_.path.clear();
    const Vec2 from = request.map_from_robot.position(), way = request.goal_in_map - from;
    const double length = norm(way);
    for (double gone = 0.0; gone < length; gone += kStep_m) add(from + way * (gone / length));
    add(request.goal_in_map);
    plan_.guide = guide_to(request);
  }
  [[nodiscard]] const Plan& collect() noexcept override { return plan_; }
  [[nodiscard]] FieldView view_field() const override { return {}; }
  [[nodiscard]] const char* backend() const noexcept override { return "straight"; }
  /// No plan comes any more.
  void end() noexcept { ended_ = true; }

 private:
  static constexpr double kStep_m = 0.1;
  static constexpr std::int32_t kSide = 96;  ///< cells of a metre, with the goal in the middle

  /// Nothing stands anywhere, and the way is straight.
  [[nodiscard]] Guide guide_to(const PlanRequest& request) noexcept {
    const auto low_x = static_cast<float>(request.goal_in_map.x) - kSide / 2,
               low_y = static_cast<float>(request.goal_in_map.y) - kSide / 2;
    for (std::int32_t j = 0; j < kSide; ++j) {
      for (std::int32_t i = 0; i < kSide; ++i) {
        const double away = norm({i + 0.5 - kSide / 2, j + 0.5 - kSide / 2}) / request.speed_mps;
        to_go_s_[static_cast<std::size_t>(j * kSide + i)] = static_cast<float>(away);
      }
    }
    return {low_x, low_y, 1.0F, kSide, false, surface_.data(), unseen_.data(), to_go_s_.data()};
  }

  void add(Vec2 point) noexcept {
    static_cast<void>(plan_.path.push_back(point));  // of 4096: the hall has room for 440
  }

  static constexpr std::size_t kCells = static_cast<std::size_t>(kSide) * kSide;
  std::vector<Place> surface_ = std::vector<Place>(kCells, Place{1e9F, 1e9F});
  std::vector<std::uint8_t> unseen_ = std::vector<std::uint8_t>(kCells, 0);
  std::vector<float> to_go_s_ = std::vector<float>(kCells, 0.0F);
  Plan plan_;
  bool ended_ = false;
};

class FaultBench;

/// What a fault is to do to the robot in the end.
enum class Outcome {
  kLatched,  ///< at rest, latched: no goal is taken before a reset
  kStopped,  ///< at rest; it may go on when the cause is gone
  kDead      ///< the controller is gone: at rest by the drives' own watchdogs
};

/// Which drives let their wheels roll out under a fault: no limit of ours holds for their way then.
enum class RollsOut {
  kNone,
  kMotors,  ///< an ODrive whose watchdog lets go, a VESC in fault
  kAll      ///< a CiA 402 drive without power, too
};

/// One row of the matrix but for drive and speed.
struct FaultCase {
  const char* name;
  void (*strike)(FaultBench&);  ///< once; null: something is wrong from the start
  Reason reason;                ///< one of these is to be named; kNone: none can be
  /// Of the loop's period: from the fault to the moment from which on the wheels only slow down.
  Duration (*limit)(Duration tick) noexcept;
  RollsOut rolls_out = RollsOut::kNone;
  Outcome outcome = Outcome::kLatched;
  const char* right_too = nullptr;            ///< the left drive's fault: its name where the right one has it; or null
  void (*every_tick)(FaultBench&) = nullptr;  ///< and then again and again; may be null
  std::optional<DriveKind> only = {};         ///< of the one kind of drive that can have it
  bool of_bus = false;                        ///< on a CAN bus alone; a Pioneer's serial line has no other sender
  bool after_ramp = false;                    ///< the limit begins where the ramp that was ordered ends
  std::optional<sim::FaultKind> miswiring = {};
  void (*at_rest)(FaultBench&) = nullptr;  ///< once the robot stands; may be null
  bool in_turn = false;                    ///< it shows as the robot sets out with a turn; else at speed, straight on
  bool at_rest_only = false;               ///< it strikes a robot that stands
  double wheels_go = 1.0;                  ///< so many times as far as the file says
  std::optional<std::size_t> of_two = {};  ///< the robot has a second scanner, at its rear; this one fails
  void (*from_start)(FaultBench&) = nullptr;  ///< before the drives are armed; may be null
  bool allow_unproved = false;                ///< of a Pioneer: says the robot file
  bool claims_free = false;  ///< the scanner has a word for "nothing within reach", as a Hokuyo; else a SICK
  std::size_t side = 0;      ///< of the drive that fails
};

struct FaultResult {
  const FaultCase* fault = nullptr;
  DriveKind drive = DriveKind::kCia402;
  double speed_mps = 0.0;
  Duration reaction{0}, limit{0};
  double stop_distance_m = 0.0;
  bool latched = false;
  std::string why_not = {};  ///< empty: ok
};

/// The whole controller with emulated drives and a scanner at the far end of its wires, in the simulated world's time.
/// It drives down a hall; a fault strikes at full speed, and what the world then sees is measured.
class FaultBench {
 public:
  /// `folder` is for the files of the run. Throws StartupError.
  FaultBench(const FaultCase& fault, DriveKind kind, double speed_mps, double rate_hz,
             const std::filesystem::path& folder);

  [[nodiscard]] FaultResult suffer();

  // What strikes may use.
  [[nodiscard]] rig::InProcessRobot& robot() noexcept { return *robot_; }
  [[nodiscard]] rig::WheelDrive& drive(std::size_t side) noexcept { return robot_->far_end().drive(side); }
  /// The one that fails.
  [[nodiscard]] rig::WheelDrive& drive() noexcept { return drive(fault_.side); }
  void tell(const char* line) { (void)robot_->desk().obey(line); }
  [[nodiscard]] emulators::ScannerServer& scanner() noexcept { return robot_->far_end().scanner(); }
  [[nodiscard]] DriveKind kind() const noexcept { return kind_; }
  [[nodiscard]] InProcessBus::Port& controllers_port() noexcept { return robot_->wires().port(0); }
  void say_as_stranger(const CanFrame& frame) noexcept { (void)robot_->wires().port(3).send(frame); }
  /// A second drive with the number of the one that fails.
  void add_twin() { robot_->far_end().add_twin(fault_.side, robot_->wires().port(4)); }
  [[nodiscard]] Duration tick_length() const noexcept { return file_.setup.tick(); }
  [[nodiscard]] StraightPlanner& planner() noexcept { return *planner_; }
  void wait(Duration time) {
    for (const Time end = due_ + time; due_ < end;) tick();
  }
  /// The loop does not run for so long, for ever with max().
  void hold_up(Duration time) noexcept;

 private:
  void watch() noexcept;
  void tick();
  [[nodiscard]] bool reach_speed();
  [[nodiscard]] double rim_mps() noexcept;
  [[nodiscard]] bool named(Reason reason) const noexcept { return reason == Reason::kNone || has(seen_, reason); }
  [[nodiscard]] bool scanner_named() const noexcept;
  [[nodiscard]] FaultResult struck_at_speed();
  /// Sets out towards a goal for which it has to turn: wrong from the start, or struck as it turns.
  [[nodiscard]] FaultResult wrong_in_turn();
  /// Struck while it stands armed, without a goal.
  [[nodiscard]] FaultResult struck_at_rest();
  void begin_watch();
  /// Returns the way from the fault until the robot has stood for ten ticks, m.
  double endure();
  [[nodiscard]] Duration limit() const noexcept;
  [[nodiscard]] bool rolls_out() const noexcept;
  [[nodiscard]] std::string complaint(const FaultResult& result);
  [[nodiscard]] std::string complaint_afterwards();

  const FaultCase& fault_;
  DriveKind kind_;
  double speed_mps_;
  RobotFile file_;
  rig::HandLivingClock clock_;
  StraightPlanner* planner_ = nullptr;  ///< robot_'s
  std::unique_ptr<rig::InProcessRobot> robot_;
  Time due_{}, held_up_until_ = kNever;
  Time struck_ = kNever, last_fast_ = kNever;
  double speed_struck_ = 0.0, motors_struck_ = 0.0;
  double way_m_ = 0.0;  ///< since the fault
  Vec2 place_{};
  Reason seen_ = Reason::kNone;  ///< since the fault
  std::uint8_t faulty_ = 0;      ///< likewise, Verdict::faulty_scanners
  bool latched_ = false;
  bool outlasts_watchdog_ = false;  ///< what held the loop up
};

/// Runs every fault on every kind of drive at 0.3, 0.6 and 1.2 m/s, in a loop of `rate_hz`, and tells each row as it
/// comes. `folder` holds the files of the run under way. Returns how many rows are not ok. Throws StartupError.
[[nodiscard]] int run_matrix(double rate_hz, const std::filesystem::path& folder,
                             const std::function<void(const FaultResult&)>& tell);

/// Every fault of the matrix, in the order in which it is printed. docs/explanation/safety.md says what each stands
/// for.
[[nodiscard]] std::span<const FaultCase> all_cases();

/// What to do where a file of the matrix cannot be written.
inline constexpr const char* kOtherOut = "choose another --out, or free some space";

/// The robot file of the matrix for a fault and one kind of drive, written into `folder` and read back like a user's: a
/// P3-DX with maximum speed `speed_mps` and a loop at `rate_hz`. Throws StartupError.
[[nodiscard]] RobotFile robot_file(const FaultCase& fault, DriveKind kind, double speed_mps, double rate_hz,
                                   const std::filesystem::path& folder);

/// The world: a hall of 44 m x 5 m, the robot at one end, looking along it. Its map is written into `folder`.
[[nodiscard]] sim::Scenario hall(const RobotModel& model, const std::filesystem::path& folder);

/// "cia402", "odrive", "vesc", "pioneer".
[[nodiscard]] const char* name_of(DriveKind kind) noexcept;

// Limits of a fault's reaction, by the loop's period: from the fault to the moment from which on the wheels only slow
// down.

using namespace std::chrono_literals;

/// Limit of an immediate reaction: one period until the loop sees the fault, one until the drives obey, and 20 ms for a
/// ramp to fall by 5 mm/s.
[[nodiscard]] inline Duration at_once(Duration tick) noexcept { return 2 * tick + 20ms; }
/// The drives' own watchdog or heartbeat consumer, 100 ms at most, after the frame before it; a wheel that nothing
/// brakes is 5 mm/s slower only after 40 ms more.
[[nodiscard]] inline Duration by_themselves(Duration tick) noexcept { return 100ms + at_once(tick); }
/// 60 ms without feedback, or two and a half periods of the loop.
[[nodiscard]] inline Duration feedback(Duration tick) noexcept {
  return std::max<Duration>(60ms, 5 * tick / 2) + at_once(tick);
}
/// Two scans of 15 Hz that do not come, and the age of the one before.
[[nodiscard]] inline Duration scans(Duration tick) noexcept { return 240ms + at_once(tick); }
/// Plans are good for 0.3 s, and then the speed falls until they are a second old; the scan that they rest on is
/// older than they are.
[[nodiscard]] inline Duration plans(Duration tick) noexcept { return 540ms + at_once(tick); }
/// A lost stop escalates to silence 100 ms after the ramp's end, and 100 ms later the drive's own watchdog acts.
[[nodiscard]] inline Duration escalated(Duration tick) noexcept { return 100ms + 100ms + at_once(tick); }
/// A stranger's NMT command, repeated: the feedback that stops coming, silence, and the drives' own watchdog.
[[nodiscard]] inline Duration taken_over(Duration tick) noexcept { return 100ms + by_themselves(tick); }
/// A scan of 15 Hz, and what it takes to come.
[[nodiscard]] inline Duration next_scan(Duration tick) noexcept { return 67ms + 67ms + at_once(tick); }
/// Two and a half periods of the loop.
[[nodiscard]] inline Duration two_ticks(Duration tick) noexcept { return 5 * tick / 2 + at_once(tick); }
/// A plain stop keeps to the limits of comfort: 1 m/s2 is reached by a jerk of at most 2 m/s3.
[[nodiscard]] inline Duration in_comfort(Duration tick) noexcept { return 500ms + at_once(tick); }
/// Half a second of motion that shows it, and what a P3-DX that turns at 0.8 rad/s needs to move enough.
[[nodiscard]] inline Duration shows_for(Duration) noexcept { return 700ms; }
/// The same, from the first scan that repeats.
[[nodiscard]] inline Duration repeats_for(Duration) noexcept { return 67ms + 500ms; }
/// Wheels that go less far than they say look like slip for long (docs/explanation/safety.md).
[[nodiscard]] inline Duration slips_for(Duration) noexcept { return 4s; }

/// Told 0.03 m/s in the first way after arming (WheelProof), a wheel that stands is 6 mm/s outside what is tolerated.
[[nodiscard]] inline Duration in_first_way(Duration) noexcept { return 6s; }
/// Speeds that stand show where they change.
[[nodiscard]] inline Duration changes_for(Duration) noexcept { return 1s; }
/// A tenth of a second in each: until it is more than a sound drive's, and then a change of speed that shows it: at
/// 0.3 m/s the next one is the stop.
[[nodiscard]] inline Duration ages_for(Duration) noexcept { return 5500ms; }

}  // namespace jaywalk::faults
