#include "drivers/ros/ros_scan.h"

#include <algorithm>
#include <cstring>

namespace jaywalk::ros {
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
  const SharedRing::Took took = ring_->read(std::as_writable_bytes(std::span(message_)));
  if (took == SharedRing::Took::kNothing) return {};
  return wire::Bytes(message_).first(took == SharedRing::Took::kTorn ? 1 : message_.size());
}

void RingLink::wait(Duration most) noexcept {
  if (state_ == State::kClosed) ring_->skip();
  ring_->wait(most);
}

}  // namespace jaywalk::ros
