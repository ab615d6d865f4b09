#include "firmware/faults/fault_bench.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "firmware/faults/matrix_files.h"
#include "hal/types/errors.h"

namespace jaywalk::faults {
namespace {

constexpr double kRest_mps = 0.01;
constexpr double kSlower_mps = 0.005;  ///< below the speed at the fault by so much: it slows down
constexpr double kCrawl_mps = 0.3, kNoise_mps = 0.01;
constexpr double kBrake_mps2 = 1.0;  ///< the matrix' model
constexpr double kBeyond_m = 0.05;   ///< motors' lag at the end of a ramp
constexpr Duration kLongest = std::chrono::seconds(15), kAfterwards = std::chrono::milliseconds(600);

std::string in_words(const char* format, double a, double b) {
  char text[120];
  std::snprintf(text, sizeof text, format, a, b);
  return text;
}

}  // namespace

FaultBench::FaultBench(DriveKind kind, double speed_mps, const std::filesystem::path& folder)
    : kind_(kind), speed_mps_(speed_mps), file_(robot_file(kind, speed_mps, folder)) {
  const auto straight = [this](std::unique_ptr<Planner>) {
    auto planner = std::make_unique<StraightPlanner>();
    planner_ = planner.get();
    return planner;
  };
  robot_ = std::make_unique<rig::InProcessRobot>(file_, hall(file_.setup.model, folder), 1, clock_, folder, straight);
  clock_.live = [this] {
    robot_->step_far_end();
    robot_->laser().step();
    watch();
  };
  while (robot_->laser().latest().sequence == 0 && clock_.now() < Time{std::chrono::seconds(10)})
    clock_.sleep_until(clock_.now() + std::chrono::milliseconds(1));
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
  if (motors > motors_struck_ - kSlower_mps && motors > kRest_mps) last_fast_ = clock_.now();
}

void FaultBench::hold_up(Duration time) noexcept {
  held_up_until_ = time == Duration::max() ? Time::max() : clock_.now() + time;
}

void FaultBench::tick() {
  due_ += file_.setup.tick();
  clock_.sleep_until(due_);
  if (due_ < held_up_until_) return;
  robot_->loop().tick(due_);
  robot_->runner().drain();
  while (robot_->loop().traces().front() != nullptr) robot_->loop().traces().pop();
  const Reason reasons = robot_->runner().last().verdict.reasons;
  latched_ = has(reasons, Reason::kLatched);
  if (struck_ != kNever) seen_ |= reasons;
}

void FaultBench::wait(Duration time) {
  for (const Time end = due_ + time; due_ < end;) tick();
}

bool FaultBench::reach_speed() {
  wait(std::chrono::milliseconds(200));
  if (robot_->desk().obey("goto 42 2.5") != "going\n") return false;
  for (const Time end = due_ + std::chrono::seconds(8); due_ < end && rim_mps() < 0.97 * speed_mps_;) tick();
  wait(std::chrono::milliseconds(200));
  return rim_mps() > 0.9 * speed_mps_ && !latched_;
}

FaultResult FaultBench::suffer(const FaultCase& fault) {
  FaultResult result{.fault = &fault, .drive = kind_, .speed_mps = speed_mps_};
  if (!reach_speed()) {
    result.why_not = "never came up to speed: " + to_string(robot_->runner().last().verdict.reasons);
    return result;
  }
  struck_ = last_fast_ = clock_.now();
  speed_struck_ = rim_mps();
  motors_struck_ = robot_->far_end().rim_speed();
  place_ = robot_->far_end().truth().map_from_robot.position();
  fault.strike(*this);
  int at_rest = 0;  // ticks
  for (const Time end = due_ + kLongest; due_ < end && at_rest < 10;) {
    if (fault.every_tick != nullptr) fault.every_tick(*this);
    tick();
    at_rest = rim_mps() < kRest_mps ? at_rest + 1 : 0;
  }
  result.reaction = last_fast_ - struck_;
  result.stop_distance_m = way_m_;
  result.latched = latched_;
  result.why_not = complaint(fault, result);
  if (result.why_not.empty()) result.why_not = complaint_afterwards(fault);
  return result;
}

std::string FaultBench::complaint(const FaultCase& fault, const FaultResult& result) {
  const double rim = rim_mps();
  if (!named(fault.reason)) return "not named: " + to_string(seen_);
  if (fault.outcome == Outcome::kCrawls && rim > kCrawl_mps + kNoise_mps)
    return in_words("still %.2f m/s, more than %.2f", rim, kCrawl_mps);
  const bool was_slower = fault.outcome == Outcome::kCrawls && speed_struck_ <= kCrawl_mps + kNoise_mps;
  if (was_slower) return "";
  const double reaction_ms = 1e3 * to_seconds(result.reaction), limit_ms = 1e3 * to_seconds(fault.limit);
  if (result.reaction > fault.limit) return in_words("reaction %.0f ms, more than %.0f", reaction_ms, limit_ms);
  if (fault.outcome == Outcome::kCrawls) return "";
  if (rim > kRest_mps) return in_words("still %.2f m/s after %.0f s", rim, to_seconds(kLongest));
  if (fault.outcome == Outcome::kLatched && !result.latched) return "not latched";
  const double v = speed_struck_;
  const double most_m = v * to_seconds(fault.limit) + v * v / (2.0 * kBrake_mps2) + kBeyond_m;
  const bool rolls_out = fault.rolls_out && kind_ != DriveKind::kCia402;
  if (rolls_out || result.stop_distance_m <= most_m) return "";
  return in_words("%.2f m to rest, more than %.2f", result.stop_distance_m, most_m);
}

/// Whatever is asked of it, it stays where it is until a reset.
std::string FaultBench::complaint_afterwards(const FaultCase& fault) {
  if (fault.outcome != Outcome::kLatched) return "";
  if (robot_->desk().obey("goto 42 2.5").rfind("refused", 0) != 0) return "takes a goal while latched";
  const double before_m = way_m_;
  for (const Time end = due_ + kAfterwards; due_ < end;) {
    if (fault.every_tick != nullptr) fault.every_tick(*this);
    tick();
  }
  return way_m_ - before_m > 0.01 ? in_words("moved %.2f m while latched (%.0f)", way_m_ - before_m, 0.0) : "";
}

}  // namespace jaywalk::faults
