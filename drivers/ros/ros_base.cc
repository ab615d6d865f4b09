#include "drivers/ros/ros_base.h"

#include <algorithm>

#include "hal/shown_text.h"

namespace jaywalk::ros {
namespace {

bool is_sound(const BaseMessage& message, Time now) noexcept {
  const bool is_known = message.id >= kWheel && message.id <= kOtherMaster;
  const bool has_size = message.size <= message.bytes.size();
  return is_known && has_size && is_recent(message.stamp_ns, now);
}

constexpr Duration kAnswerLimit = std::chrono::seconds(2);  // jaywalk_dds finds new rings, and nodes each other
constexpr Duration kSilence = std::chrono::milliseconds(150);

}  // namespace

bool RosBus::send(const CanFrame& frame) noexcept {
  const BaseMessage message{clock_.now().time_since_epoch().count(), frame.id, frame.size, frame.bytes};
  orders_->write(std::as_bytes(std::span(&message, 1)));
  return true;
}

bool RosBus::receive(ReceivedFrame& received) noexcept {
  BaseMessage message;
  for (std::size_t k = 0; k < kBaseRing.slots; ++k) {
    const SharedRing::Took took = states_->read(std::as_writable_bytes(std::span(&message, 1)));
    if (took == SharedRing::Took::kNothing) return false;
    if (took == SharedRing::Took::kMessage && is_sound(message, clock_.now())) {
      received.stamp = Time(Duration(message.stamp_ns));
      received.frame = {.id = message.id, .size = static_cast<std::uint8_t>(message.size), .bytes = message.bytes};
      return true;
    }
    ++malformed_;
  }
  return false;
}

CanHealth RosBus::health() const noexcept { return {.frames_lost = states_->lost(), .malformed = malformed_}; }

RosBase::RosBase(CanBus& bus, Clock& clock, const BaseSetup& setup)
    : MotorPair(bus, clock,
                {std::max({kSilence, 3 * setup.tick, duration_from_seconds(setup.times.oldest_report_s())}),
                 kAnswerLimit, setup.stop, setup.allow_unproved, true}),
      setup_(setup),
      shown_{ShownReports(setup.times, setup.tick), ShownReports(setup.times, setup.tick)} {}

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
  shown_[index].note(clock().now(), static_cast<double>(wheel->speed_radps));
}

// A base that is told nothing is not told to let go either: it is at rest then.
void RosBase::send_order(std::size_t index, MotorOrder order, double speed_radps) noexcept {
  torque_on_[index] = order == MotorOrder::kHold || order == MotorOrder::kRun;
  if (order == MotorOrder::kOff) return note_obeys(index, false);
  send(to_frame(kWheelOrder + static_cast<std::uint32_t>(index), {static_cast<float>(speed_radps), 0}));
}

void RosBase::begin_proof(std::size_t index) noexcept {
  shown_[index].begin(clock().now());
  zero_sent_ = kNever;
}

ProofResult RosBase::continue_proof(std::size_t index) noexcept {
  const Time now = clock().now();
  if (age(zero_sent_, now) >= setup_.tick) {
    for (std::uint32_t side = 0; side < 2; ++side) send(to_frame(kWheelOrder + side, {}));
    zero_sent_ = now;
  }
  const ShownReports& shown = shown_[index];
  if (!shown.is_over(now)) return ProofResult::kUnderWay;
  listened_[index] = listeners_;
  const bool is_well =
      listeners_ > 0 && shown.is_often_enough() && shown.fastest_radps() <= setup_.stop.tolerance_radps;
  return is_well ? ProofResult::kUnproved : ProofResult::kFailed;
}

std::string RosBase::proof_line(std::size_t index) const {
  const ShownReports& shown = shown_[index];
  return (index == 0 ? "left wheel: " : "right wheel: ") + std::to_string(listened_[index]) + " nodes listen to " +
         setup_.command + formatted(", %.0f readings a second from ", shown.per_second()) + setup_.odometry +
         formatted(", at most %.2f rad/s at commanded zero", shown.fastest_radps()) +
         "; that the base stops by itself without commands shows only while it drives: NOT PROVED";
}

std::string RosBase::proof_remedy(std::size_t index) const {
  const ShownReports& shown = shown_[index];
  if (listened_[index] == 0) return "start the node that drives the base, in this domain, or correct [drive] command";
  if (shown.fastest_radps() > setup_.stop.tolerance_radps) return "see why the base moves, or its odometry says so";
  if (!shown.is_often_enough()) return shown.remedy();
  return "see that the base's own timeout for commands (cmd_vel_timeout) is short, and write allow_unproved = true";
}

}  // namespace jaywalk::ros
