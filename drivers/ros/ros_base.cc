#include "drivers/ros/ros_base.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace jaywalk::ros {

namespace {

constexpr Duration kAnswerLimit = std::chrono::seconds(2);  // jaywalk_dds finds new rings, and nodes each other
constexpr Duration kSilence = std::chrono::milliseconds(150), kSettling = std::chrono::milliseconds(300);
constexpr Duration kProof = std::chrono::milliseconds(500);
constexpr int kReports = 10;               // of the period stated, in a proof
constexpr double kShown = 0.8;             // of those that its period promises
constexpr double kLongestReport_s = 0.25;  // report_ms

/// Long enough to tell how often it reports.
Duration proof_time(const DriveTimes& times) {
  return std::max(kProof, duration_from_seconds(kReports * times.report_s));
}

}  // namespace

RosBase::RosBase(CanBus& bus, Clock& clock, const BaseSetup& setup)
    : MotorPair(bus, clock,
                {std::max({kSilence, 3 * setup.tick, duration_from_seconds(setup.times.oldest_report_s())}), kSettling,
                 kAnswerLimit, setup.stop, setup.allow_unproved, true}),
      setup_(setup) {}

std::string RosBase::inspect(std::size_t side) {
  await_motor(side);
  begin_proof(side);
  ProofResult result = ProofResult::kUnderWay;
  while ((result = continue_proof(side)) == ProofResult::kUnderWay) pass_time();
  if (result == ProofResult::kFailed || !setup_.allow_unproved)
    throw StartupError(proof_line(side), proof_remedy(side));
  return proof_line(side);
}

StartupError RosBase::absence(std::size_t) const {
  return {setup_.odometry + ": no odometry comes",
          "start the robot's ROS 2 nodes, and jaywalk_dds with this file and their domain"};
}

void RosBase::take(const ReceivedFrame& received) noexcept {
  const CanFrame& frame = received.frame;
  if (frame.id == kOtherMaster) return note_foreign(frame);
  if (frame.id == kListeners) listeners_ = frame.bytes[0];
  const auto wheel = wheel_in(frame);
  if (!wheel || frame.id < kWheel || frame.id > kWheel + 1) return;
  const std::size_t index = frame.id - kWheel;
  note_turned(index, received.stamp, kAngle_rad * counted(angles_[index], wheel->angle));
  angles_[index] = wheel->angle;
  note_heard(index, received.stamp);
  note_speed(index, received.stamp, static_cast<double>(wheel->speed_radps));
  note_obeys(index, torque_on_[index] && listeners_ > 0);
  Shown& shown = shown_[index];
  const Time now = clock().now();
  if (++shown.readings > 1) shown.longest = std::max(shown.longest, now - shown.read);
  shown.read = now;
  shown.fastest_radps = std::fmax(shown.fastest_radps, std::fabs(static_cast<double>(wheel->speed_radps)));
}

// A base that is told nothing is not told to let go either: it is at rest then.
void RosBase::send_order(std::size_t index, MotorOrder order, double speed_radps) noexcept {
  torque_on_[index] = order == MotorOrder::kHold || order == MotorOrder::kRun;
  if (order == MotorOrder::kOff) return note_obeys(index, false);
  send(to_frame(kWheelOrder + static_cast<std::uint32_t>(index), {static_cast<float>(speed_radps), 0}));
}

void RosBase::begin_proof(std::size_t index) noexcept {
  shown_[index] = {.began = clock().now()};
  zero_sent_ = kNever;
}

ProofResult RosBase::continue_proof(std::size_t index) noexcept {
  const Time now = clock().now();
  if (age(zero_sent_, now) >= setup_.tick) {
    for (std::uint32_t side = 0; side < 2; ++side) send(to_frame(kWheelOrder + side, {}));
    zero_sent_ = now;
  }
  if (now - shown_[index].began < proof_time(setup_.times)) return ProofResult::kUnderWay;
  shown_[index].listeners = listeners_;
  const Shown& shown = shown_[index];
  const bool is_well =
      shown.listeners > 0 && is_often_enough(shown) && shown.fastest_radps <= setup_.stop.tolerance_radps;
  return is_well ? ProofResult::kUnproved : ProofResult::kFailed;
}

bool RosBase::is_often_enough(const Shown& shown) const noexcept {
  const double stated = to_seconds(proof_time(setup_.times)) / setup_.times.report_s;
  const Duration oldest = duration_from_seconds(setup_.times.oldest_report_s()) + setup_.tick;  // read once a tick
  return shown.readings >= std::floor(kShown * stated) && shown.longest <= oldest;
}

/// Periods and delays that it showed, for the robot file; or that no robot file can have them.
std::string RosBase::times_remedy(const Shown& shown) const {
  const double report_s = to_seconds(proof_time(setup_.times)) / std::max(shown.readings, 1);
  const double late_s = std::max(to_seconds(shown.longest) - report_s, 0.0);
  std::array<char, 200> text{};
  std::snprintf(text.data(), text.size(),
                report_s <= kLongestReport_s
                    ? "write report_ms = %.0f and report_late_ms = %.0f in [drive], or have it published more often"
                    : "have it published at least 4 times a second (now every %.0f ms, up to %.0f ms late)",
                std::ceil(1e3 * report_s), 10.0 * std::ceil(100.0 * late_s));
  return text.data();
}

std::string RosBase::proof_line(std::size_t index) const {
  const Shown& shown = shown_[index];
  std::array<char, 300> text{};
  std::snprintf(
      text.data(), text.size(),
      "%s wheel: %d nodes listen to %s, %.0f readings a second from %s, at most %.2f rad/s at commanded zero; "
      "that the base stops by itself without commands shows only while it drives: NOT PROVED",
      index == 0 ? "left" : "right", shown.listeners, setup_.command.c_str(),
      shown.readings / to_seconds(proof_time(setup_.times)), setup_.odometry.c_str(), shown.fastest_radps);
  return text.data();
}

std::string RosBase::proof_remedy(std::size_t index) const {
  const Shown& shown = shown_[index];
  if (shown.listeners == 0) return "start the node that drives the base, in this domain, or correct [drive] command";
  if (shown.fastest_radps > setup_.stop.tolerance_radps) return "see why the base moves, or its odometry says so";
  if (!is_often_enough(shown)) return times_remedy(shown);
  return "see that the base's own timeout for commands (cmd_vel_timeout) is short, and write allow_unproved = true";
}

}  // namespace jaywalk::ros
