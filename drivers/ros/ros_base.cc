#include "drivers/ros/ros_base.h"

#include <algorithm>
#include <cstdio>
#include <cstring>

namespace jaywalk::ros {
namespace {

bool is_sound(const BaseMessage& message, Time now) noexcept {
  const bool is_known = message.id >= kWheel && message.id <= kOtherMaster;
  const bool has_size = message.size <= message.bytes.size();
  return is_known && has_size && is_recent(message.stamp_ns, now);
}

constexpr Duration kAnswerLimit = std::chrono::seconds(2);  // jaywalk_dds finds new rings, and nodes each other
constexpr Duration kSilence = std::chrono::milliseconds(150), kSettling = std::chrono::milliseconds(300);

}  // namespace

SendResult RosBus::send(const CanFrame& frame) noexcept {
  const BaseMessage message{clock_.now().time_since_epoch().count(), frame.id, frame.size, frame.bytes};
  orders_->write(std::as_bytes(std::span(&message, 1)));
  return SendResult::kQueued;
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
                {std::max({kSilence, 3 * setup.tick, duration_from_seconds(setup.times.oldest_report_s())}), kSettling,
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
  std::array<char, 300> text{};
  std::snprintf(
      text.data(), text.size(),
      "%s wheel: %d nodes listen to %s, %.0f readings a second from %s, at most %.2f rad/s at commanded zero; "
      "that the base stops by itself without commands shows only while it drives: NOT PROVED",
      index == 0 ? "left" : "right", listened_[index], setup_.command.c_str(), shown.per_second(),
      setup_.odometry.c_str(), shown.fastest_radps());
  return text.data();
}

std::string RosBase::proof_remedy(std::size_t index) const {
  const ShownReports& shown = shown_[index];
  if (listened_[index] == 0) return "start the node that drives the base, in this domain, or correct [drive] command";
  if (shown.fastest_radps() > setup_.stop.tolerance_radps) return "see why the base moves, or its odometry says so";
  if (!shown.is_often_enough()) return shown.remedy();
  return "see that the base's own timeout for commands (cmd_vel_timeout) is short, and write allow_unproved = true";
}

namespace {

constexpr float kTurn_rad = 6.2832F, kHalfStep_rad = 0.01F, kFarthest_m = 1000.0F;
constexpr Duration kLongestPeriod = std::chrono::seconds(2);

// Written so that what is no number is refused.
bool makes_a_fan(const ScanMessage& m) noexcept {
  if (m.beam_count < kLeastBeams || m.beam_count > kMaxBeams || m.angle_step_rad == 0.0F) return false;
  const float swept_rad = std::fabs(m.angle_step_rad) * static_cast<float>(m.beam_count - 1);
  return std::fabs(m.first_angle_rad) <= kTurn_rad && swept_rad <= kTurn_rad + kHalfStep_rad;
}

bool has_limits(const ScanMessage& m) noexcept {
  return m.range_min_m >= 0.0F && m.range_max_m > m.range_min_m && m.range_max_m <= kFarthest_m;
}

bool has_times(const ScanMessage& m, Time arrival) noexcept {
  const auto within = [](std::int64_t ns, Duration most) { return ns >= 0 && ns <= most.count(); };
  return within(m.period_ns, kLongestPeriod) && m.period_ns > 0 && within(m.sweep_ns, Duration(m.period_ns)) &&
         is_recent(m.stamp_ns, arrival);
}

float range_of(float range_m, float range_max_m, bool infinity_is_free) noexcept {
  const bool is_known = range_m > 0.0F && (range_m < range_max_m || infinity_is_free);
  return is_known ? range_m : 0.0F;
}

}  // namespace

Heard decode_scan(wire::Bytes message, Time arrival, bool infinity_is_free, LaserScan& scan) noexcept {
  ScanMessage m;
  if (message.size() != sizeof m) return Heard::kMalformed;
  std::memcpy(&m, message.data(), sizeof m);
  if (!makes_a_fan(m) || !has_limits(m) || !has_times(m, arrival)) return Heard::kMalformed;
  scan.stamp = Time(Duration(m.stamp_ns));
  scan.beam_count = m.beam_count;
  scan.first_angle_rad = m.first_angle_rad;
  scan.angle_step_rad = m.angle_step_rad;
  scan.range_min_m = m.range_min_m;
  scan.range_max_m = m.range_max_m;
  scan.sweep = Duration(m.sweep_ns);
  scan.period = Duration(m.period_ns);
  const auto end = m.range_m.begin() + m.beam_count;
  std::transform(m.range_m.begin(), end, scan.range_m.begin(),
                 [&](float range_m) { return range_of(range_m, m.range_max_m, infinity_is_free); });
  return Heard::kScan;
}

void RosScanProtocol::hear(wire::Bytes bytes) noexcept {
  heard_ = std::min(bytes.size(), message_.size());
  std::copy_n(bytes.begin(), heard_, message_.begin());
}

Heard RosScanProtocol::next(Time arrival, LaserScan& scan) noexcept {
  if (heard_ == 0) return Heard::kNothing;
  const std::size_t size = heard_;
  heard_ = 0;
  return decode_scan(wire::Bytes(message_).first(size), arrival, infinity_is_free_, scan);
}

void RingLink::open() noexcept {
  ring_->skip();
  state_ = State::kOpen;
}

wire::Bytes RingLink::read(std::span<std::uint8_t>) noexcept {
  if (state_ != State::kOpen) return {};
  switch (ring_->read(std::as_writable_bytes(std::span(message_)))) {
    case SharedRing::Took::kNothing: return {};
    case SharedRing::Took::kTorn: return wire::Bytes(message_).first(1);
    case SharedRing::Took::kMessage: break;
  }
  return message_;
}

void RingLink::wait(Duration most) noexcept {
  if (state_ == State::kClosed) ring_->skip();
  ring_->wait(most);
}

}  // namespace jaywalk::ros
