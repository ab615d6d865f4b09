#include "hil/faults/fault_matrix.h"

#include <array>

#include "firmware/safety/wheel_proof.h"
#include "hal/shown_text.h"
#include "hal/text_file.h"

namespace jaywalk::faults {
namespace {

constexpr std::array kKinds{DriveKind::kCia402, DriveKind::kOdrive, DriveKind::kVesc, DriveKind::kPioneer};
constexpr std::array kSpeeds_mps{0.3, 0.6, 1.2};

template <class Visit>
void for_each_row(Visit&& visit) {
  for (const FaultCase& fault : all_cases()) {
    for (const DriveKind kind : kKinds) {
      if (fault.only && *fault.only != kind) continue;
      if (fault.of_bus && kind == DriveKind::kPioneer) continue;
      for (const double speed : kSpeeds_mps) visit(fault, kind, speed);
    }
  }
}

constexpr double kLong_m = 44.0, kWide_m = 5.0;

/// The drive's own keys; counts, turns and pole pairs are those of the bench's motors. A Pioneer has its factory's
/// cycle.
std::string drive_keys(DriveKind kind) {
  if (kind == DriveKind::kPioneer) return "device = \"in-process\"\nticks_per_mm = 128\n";
  const std::string can = "can = \"in-process\"\nright_reversed = true\n";
  if (kind == DriveKind::kOdrive) return can + "left_node = 3\nright_node = 4\nmotor_turns_per_wheel_turn = 10\n";
  if (kind == DriveKind::kVesc) return can + "left_node = 23\nright_node = 24\nelectrical_turns_per_wheel_turn = 50\n";
  return can + "left_node = 2\nright_node = 3\ncounts_per_wheel_turn = 76600\n";
}

/// A P3-DX (hal/types/robot_model.h) as a file, with a fastest speed of its own.
std::string model_text(double speed_mps) {
  return "name = \"matrix\"\n"
         "[footprint]\nfront_m = 0.210\nrear_m = 0.301\nhalf_width_m = 0.2125\n"
         "[drive]\nwheel_radius_m = 0.0975\ntrack_width_m = 0.33\nmax_wheel_speed_radps = 14.0\n"
         "[limits]\nmax_speed_mps = " +
         std::to_string(speed_mps) +
         "\nmax_turn_radps = 1.5\nmax_accel_mps2 = 0.5\nmax_turn_accel_radps2 = 3.0\nmax_jerk_mps3 = 2.0\n"
         "brake_mps2 = 1.0\n"
         "[laser]\nmount = [0.0, 0.0, 0.0]\nfov_deg = 270.0\nbeams = 541\nrate_hz = 15.0\nrange_min_m = 0.05\n"
         "range_m = 50.0\n";  // across the hall: a SICK has no word for "nothing in reach" that proves it
}

constexpr double kSlower_mps = 0.005;  ///< below the speed at the fault by so much: it slows down
constexpr double kBrake_mps2 = 1.0;    ///< the matrix' model
constexpr double kBeyond_m = 0.05;     ///< motors' lag at the end of a ramp
/// What shows in the drives' reports: it shows later where they are rare.
constexpr Reason kByReports =
    Reason::kDrive | Reason::kWheelsStale | Reason::kWheelsDisobey | Reason::kMotionMismatch | Reason::kStopUnconfirmed;
constexpr Duration kLongest = std::chrono::seconds(15), kAfterwards = std::chrono::milliseconds(600);

}  // namespace

int run_matrix(double rate_hz, const std::filesystem::path& folder,
               const std::function<void(const FaultResult&)>& tell) {
  int bad = 0;
  for_each_row([&](const FaultCase& fault, DriveKind kind, double speed_mps) {
    const FaultResult result = FaultBench(fault, kind, speed_mps, rate_hz, folder).suffer();
    bad += result.why_not.empty() ? 0 : 1;
    tell(result);
  });
  return bad;
}

const char* name_of(DriveKind kind) noexcept {
  constexpr std::array kNames{"cia402", "odrive", "vesc", "dds", "pioneer"};
  return kNames.at(static_cast<std::size_t>(kind));
}

RobotFile robot_file(const FaultCase& fault, DriveKind kind, double speed_mps, double rate_hz,
                     const std::filesystem::path& folder) {
  const std::string scans = fault.claims_free ? "\"hokuyo\"\nbeams = 1081\nrange_m = 30.0\n" : "\"sick-cola-b\"\n";
  const std::string scanner = "[[laser]]\nhost = \"127.0.0.1\"\nkind = " + scans;
  write_text(folder / "model.toml", model_text(speed_mps), kOtherOut);
  write_text(folder / "robot.toml",
             std::string("model = \"model.toml\"\nstart = [1.5, 2.5, 0.0]\nrate_hz = ") + std::to_string(rate_hz) +
                 "\n" + scanner +
                 (fault.of_two ? scanner + "port = 2113\nmount = [-0.2, 0.0, 3.14159]\nrate_hz = 20.0\n" : "") +
                 "[drive]\nkind = \"" + name_of(kind) + "\"\n" + drive_keys(kind),
             kOtherOut);
  RobotFile file = load_robot_file(folder / "robot.toml");
  file.setup.backend = Backend::kCpu;
  return file;
}

sim::Scenario hall(const RobotModel& model, const std::filesystem::path& folder) {
  const std::string far = std::to_string(static_cast<int>(1000.0 * kLong_m));
  const std::string left = std::to_string(static_cast<int>(1000.0 * kWide_m));
  write_text(folder / "hall.map",
             "2D-Map\nNumLines: 4\nLINES\n0 0 " + far + " 0\n" + far + " 0 " + far + " " + left + "\n" + far + " " +
                 left + " 0 " + left + "\n0 " + left + " 0 0\nDATA\n",
             kOtherOut);
  sim::Scenario scenario;
  scenario.name = "hall";
  scenario.map_kind = sim::MapKind::kAria;
  scenario.map_file = folder / "hall.map";
  scenario.model = model;
  scenario.model.laser.noise_m = 0.01;
  scenario.start = {1.5, 0.5 * kWide_m, 0.0};
  scenario.goal = {kLong_m - 2.0, 0.5 * kWide_m};
  return scenario;
}

FaultBench::FaultBench(const FaultCase& fault, DriveKind kind, double speed_mps, double rate_hz,
                       const std::filesystem::path& folder)
    : fault_(fault), kind_(kind), speed_mps_(speed_mps), file_(robot_file(fault, kind, speed_mps, rate_hz, folder)) {
  file_.drive.arcos.allow_unproved = fault.allow_unproved;
  const auto straight = [this](const ControlSetup&) {
    auto planner = std::make_unique<StraightPlanner>();
    planner_ = planner.get();
    return ChosenPlanner{std::move(planner), ""};
  };
  sim::Scenario world = hall(file_.setup.model, folder);
  if (fault.wheels_go != 1.0) {
    world.truth.left_wheel_radius_m = fault.wheels_go * world.model.drive.wheel_radius_m;
    world.truth.right_wheel_radius_m = world.truth.left_wheel_radius_m;
  }
  if (fault.miswiring) world.faults = {{.at_s = 0.0, .for_s = 1e6, .kind = *fault.miswiring}};
  robot_ = std::make_unique<rig::InProcessRobot>(file_, world, 1, clock_, rig::InProcessRobot::Run{folder, straight});
  clock_.live = [this] {
    robot_->step_far_end();
    for (const auto& laser : robot_->lasers()) laser->step();
    watch();
  };
  const auto is_silent = [](const auto& laser) { return laser->latest().sequence == 0; };
  while (std::ranges::any_of(robot_->lasers(), is_silent) && clock_.now() < Time{std::chrono::seconds(10)})
    clock_.sleep_until(clock_.now() + std::chrono::milliseconds(1));
  if (fault.from_start != nullptr) fault.from_start(*this);
  static_cast<void>(robot_->drive().arm());
  due_ = clock_.now();
}

/// The faster wheel's contact point, as the world has it.
double FaultBench::rim_mps() noexcept {
  const Twist2 twist = robot_->far_end().truth().twist;
  return std::fabs(twist.v_mps) + std::fabs(twist.w_radps) * 0.5 * file_.setup.model.drive.track_width_m;
}

void FaultBench::watch() noexcept {
  if (struck_ == kNever) return;
  const Vec2 place = robot_->far_end().truth().map_from_robot.position();
  way_m_ += distance(place_, place);
  place_ = place;
  // What the motors are at, without the wheels' slip: a speed that a share of a percent more or less would blur.
  const double motors = robot_->far_end().rim_speed();
  if (motors > motors_struck_ - kSlower_mps && motors > kAtRest_mps) last_fast_ = clock_.now();
}

void FaultBench::hold_up(Duration time) noexcept {
  held_up_until_ = time == Duration::max() ? Time::max() : clock_.now() + time;
  outlasts_watchdog_ = time > rig::kOdriveWatchdog;
}

void FaultBench::tick() {
  due_ += file_.setup.tick();
  clock_.sleep_until(due_);
  if (due_ < held_up_until_) return;
  robot_->loop().tick(due_);
  robot_->runner().drain();
  while (robot_->loop().traces().front() != nullptr) robot_->loop().traces().pop();
  const Verdict& verdict = robot_->runner().last().verdict;
  latched_ = has(verdict.reasons, Reason::kLatched);
  if (struck_ == kNever) return;
  seen_ |= verdict.reasons;
  faulty_ |= verdict.faulty_scanners;
}

bool FaultBench::reach_speed() {
  wait(std::chrono::milliseconds(200));
  if (robot_->desk().obey("goto 42 2.5") != "going\n") return false;
  for (const Time end = due_ + std::chrono::seconds(8); due_ < end && rim_mps() < 0.97 * speed_mps_;) tick();
  wait(std::chrono::milliseconds(200));
  return rim_mps() > 0.9 * speed_mps_ && !latched_;
}

FaultResult FaultBench::suffer() {
  FaultResult result = fault_.at_rest_only ? struck_at_rest() : fault_.in_turn ? wrong_in_turn() : struck_at_speed();
  result.fault = &fault_;
  result.drive = kind_;
  result.speed_mps = speed_mps_;
  result.limit = limit();
  result.latched = latched_;
  if (result.why_not.empty()) result.why_not = complaint(result);
  if (result.why_not.empty()) result.why_not = complaint_afterwards();
  return result;
}

void FaultBench::begin_watch() {
  struck_ = last_fast_ = clock_.now();
  speed_struck_ = rim_mps();
  motors_struck_ = robot_->far_end().rim_speed();
  place_ = robot_->far_end().truth().map_from_robot.position();
}

double FaultBench::endure() {
  int at_rest = 0;
  for (const Time end = due_ + kLongest; due_ < end && at_rest < 10;) {
    if (fault_.every_tick != nullptr) fault_.every_tick(*this);
    tick();
    at_rest = rim_mps() < kAtRest_mps ? at_rest + 1 : 0;
  }
  return way_m_;
}

FaultResult FaultBench::struck_at_speed() {
  FaultResult result;
  if (!reach_speed()) {
    result.why_not = "never came up to speed: " + to_string(robot_->runner().last().verdict.reasons);
    return result;
  }
  begin_watch();
  fault_.strike(*this);
  result.stop_distance_m = endure();
  result.reaction = last_fast_ - struck_;
  if (fault_.at_rest != nullptr) fault_.at_rest(*this);
  return result;
}

// The goal lies 106 degrees to the left, so that the robot has to turn: a gentle arc at 0.3 m/s is too slow for the
// scan-based check (docs/explanation/safety.md). The reaction time starts when the left wheel, whose wiring is wrong,
// is commanded faster than the first way after arming is driven (WheelProof): what was told in that is told in time.
FaultResult FaultBench::wrong_in_turn() {
  constexpr double kDriving_mps = WheelProof::kSlow_mps + 0.02;
  FaultResult result;
  wait(std::chrono::milliseconds(200));
  if (robot_->desk().obey("goto 1.0 4.2") != "going\n") result.why_not = "takes no goal";
  const auto asked_mps = [this] {
    return std::fabs(robot_->runner().last().command.left_radps) * file_.setup.model.drive.wheel_radius_m;
  };
  begin_watch();  // what is told before that wheel turns so fast, by the other one, is told in time
  for (const Time end = due_ + std::chrono::seconds(6); due_ < end && asked_mps() < kDriving_mps && !latched_;) tick();
  begin_watch();
  if (fault_.strike != nullptr) fault_.strike(*this);
  for (const Time end = due_ + std::chrono::seconds(5); due_ < end && !latched_;) tick();
  result.reaction = clock_.now() - struck_;
  result.stop_distance_m = endure();
  return result;
}

FaultResult FaultBench::struck_at_rest() {
  FaultResult result;
  wait(std::chrono::seconds(2));
  begin_watch();
  fault_.strike(*this);
  tick();
  place_ = robot_->far_end().truth().map_from_robot.position();  // what a person carries it is no way of its own
  way_m_ = 0.0;
  for (const Time end = due_ + std::chrono::seconds(5); due_ < end && !latched_;) tick();
  result.reaction = clock_.now() - struck_;
  result.stop_distance_m = endure();
  return result;
}

Duration FaultBench::limit() const noexcept {
  const double ramp_s = fault_.after_ramp ? speed_struck_ / kBrake_mps2 : 0.0;
  const double usual_s = std::max(0.06, 2.5 * to_seconds(file_.setup.tick()));
  const double late_s = std::max(file_.setup.model.drive.times.oldest_report_s() - usual_s, 0.0);
  return fault_.limit(file_.setup.tick()) +
         duration_from_seconds(ramp_s + (has(kByReports, fault_.reason) ? late_s : 0.0));
}

bool FaultBench::rolls_out() const noexcept {
  const bool lets_go = kind_ == DriveKind::kOdrive && outlasts_watchdog_;
  return lets_go || fault_.rolls_out == RollsOut::kAll ||
         (fault_.rolls_out == RollsOut::kMotors && kind_ != DriveKind::kCia402 && kind_ != DriveKind::kPioneer);
}

/// Whether the supervisor named the scanner that failed, and no other. motion_mismatch names none: the wheels may be
/// at fault.
bool FaultBench::scanner_named() const noexcept {
  if (!fault_.of_two || (fault_.in_turn && faulty_ == 0)) return true;
  return faulty_ == 1U << *fault_.of_two;
}

std::string FaultBench::complaint(const FaultResult& result) {
  const double rim = rim_mps();
  if (!named(fault_.reason) || !scanner_named()) return "not named: " + to_string(seen_, faulty_);
  const double reaction_ms = 1e3 * to_seconds(result.reaction), limit_ms = 1e3 * to_seconds(result.limit);
  if (result.reaction > result.limit) return formatted("reaction %.0f ms, more than %.0f", reaction_ms, limit_ms);
  if (rim > kAtRest_mps) return formatted("still %.2f m/s after %.0f s", rim, to_seconds(kLongest));
  if (fault_.outcome == Outcome::kLatched && !result.latched) return "not latched";
  const double v = speed_struck_;
  const double most_m = v * to_seconds(result.limit) + v * v / (2.0 * kBrake_mps2) + kBeyond_m;
  if (rolls_out() || fault_.in_turn || result.stop_distance_m <= most_m) return "";
  return formatted("%.2f m to rest, more than %.2f", result.stop_distance_m, most_m);
}

/// Whatever is asked of it, it stays where it is until a reset.
std::string FaultBench::complaint_afterwards() {
  if (fault_.outcome != Outcome::kLatched) return "";
  if (robot_->desk().obey("goto 42 2.5").rfind("refused", 0) != 0) return "takes a goal while latched";
  const double before_m = way_m_;
  for (const Time end = due_ + kAfterwards; due_ < end;) {
    if (fault_.every_tick != nullptr) fault_.every_tick(*this);
    tick();
  }
  return way_m_ - before_m > 0.01 ? formatted("moved %.2f m while latched (0)", way_m_ - before_m) : "";
}

}  // namespace jaywalk::faults
