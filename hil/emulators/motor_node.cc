#include "hil/emulators/motor_node.h"

#include <array>
#include <bit>
#include <vector>

#include "hil/emulators/byte_server.h"

namespace jaywalk::emulators {
namespace {

constexpr double kRamp_turns_per_s2 = 20.0;
constexpr double kRollOut_turns_per_s2 = 2.0;  ///< without torque
constexpr std::uint32_t kEstop = 0x02000000;
constexpr Duration kPeriod = std::chrono::milliseconds(10);  ///< of heartbeats, estimates and status messages

constexpr double kRamp_erpm_per_s = 30000.0;
constexpr double kRollOut_erpm_per_s = 1500.0;
constexpr std::size_t kSettingsBytes = 300;  ///< some firmware has more, some fewer

}  // namespace

void MotorNode::step(Time now) {
  ReceivedFrame received;
  while (bus_.receive(received))
    if (connected_) take(received.frame, now);
  watch(now);
  if (stepped_ != kNever) move(to_seconds(now - stepped_));
  stepped_ = now;
  say(now);
}

void OdriveNode::take(const CanFrame& frame, Time now) noexcept {
  if (frame.extended || frame.id >> 5U != node_) return;
  fed_ = now;  // whatever is said to it feeds the watchdog
  if (deaf_) return;
  const auto word = wire::little_endian<std::uint32_t>(frame.bytes);
  switch (frame.id & 0x1FU) {
    case 0x02: return disarm(kEstop);
    case 0x07:
      if (word == 1) state_ = 1;
      if (word == 8 && errors_ == 0 && procedure_ == 0) state_ = 8;
      return;
    case 0x0B: control_mode_ = word; return;
    case 0x0D:
      if (!stuck_) target_ = static_cast<double>(std::bit_cast<float>(word));
      return;
    case 0x18: errors_ = lasting_error_; return;
    default: return;
  }
}

void OdriveNode::watch(Time now) noexcept {
  const bool expired = watchdog_ > Duration{0} && fed_ != kNever && now - fed_ > watchdog_;
  if (!expired || (errors_ & expired_) != 0) return;
  if (lies_)
    errors_ |= expired_;
  else
    disarm(expired_);
}

void OdriveNode::disarm(std::uint32_t error) noexcept {
  errors_ |= error;
  state_ = 1;
}

void OdriveNode::set_lasting_error(std::uint32_t error) noexcept {
  lasting_error_ = error;
  if (error != 0) disarm(error);
}

void OdriveNode::restart() noexcept {
  state_ = 1;
  errors_ = lasting_error_;
  target_ = 0.0;
  control_mode_ = 3;
  forget();
}

void OdriveNode::move(double seconds) noexcept {
  const double before = velocity_;
  const bool follows = state_ == 8 && control_mode_ == 2;
  velocity_ = follows ? ramped(velocity_, target_, kRamp_turns_per_s2 * seconds)
                      : ramped(velocity_, 0.0, kRollOut_turns_per_s2 * seconds);
  position_ += 0.5 * (before + velocity_) * seconds;
}

void OdriveNode::say(Time now) noexcept {
  if (is_due(said_heartbeat_, kPeriod, now)) send(0x01, errors_, state_ | static_cast<std::uint32_t>(procedure_) << 8U);
  if (!estimates_ || !is_due(said_estimates_, kPeriod, now)) return;
  send(0x09, std::bit_cast<std::uint32_t>(static_cast<float>(felt_position())),
       std::bit_cast<std::uint32_t>(static_cast<float>(felt_velocity())));
}

void OdriveNode::send(std::uint32_t command, std::uint32_t first, std::uint32_t second) noexcept {
  CanFrame frame{.id = static_cast<std::uint32_t>(node_) << 5U | command, .size = 8};
  wire::put_little_endian(first | std::uint64_t{second} << 32U, frame.bytes);
  MotorNode::send(frame);
}

void VescNode::set_timeout(std::uint32_t timeout_ms, float brake_current_a) noexcept {
  timeout_ms_ = told_ms_ = timeout_ms;
  brake_current_a_ = brake_current_a;
}

void VescNode::watch(Time now) noexcept {
  const bool expired = timeout_ms_ > 0 && fed_ != kNever && now - fed_ > std::chrono::milliseconds(timeout_ms_);
  if (expired) mode_ = brake_current_a_ > 0.0F ? Mode::kBrake : Mode::kCurrent;
}

void VescNode::take(const CanFrame& frame, Time now) {
  if (!frame.extended || (frame.id & 0xFFU) != node_) return;
  const auto word = static_cast<std::int32_t>(wire::big_endian<std::uint32_t>(frame.bytes));
  const bool is_order = frame.id >> 8U <= 3;
  if (is_order) fed_ = now;
  if (is_order && (deaf_ || (stuck_ && frame.id >> 8U == 3))) return;
  switch (frame.id >> 8U) {
    case 1: mode_ = Mode::kCurrent; return;
    case 2: mode_ = Mode::kBrake; return;
    case 3:
      mode_ = Mode::kSpeed;
      target_erpm_ = word;
      return;
    case 8: return answer(frame.payload());
    default: return;
  }
}

void VescNode::answer(std::span<const std::uint8_t> question) {
  if (!answers_ || question.size() < 3) return;
  if (question[2] == 17) send_settings(question[0]);
  if (question[2] == 50 && question.size() == 7) {
    const std::array<std::uint8_t, 8> told{node_, 1, 50, question[3], question[4], question[5], question[6], fault_};
    send(8, question[0], told);
  }
}

void VescNode::send_settings(std::uint8_t to) {
  std::vector<std::uint8_t> all(kSettingsBytes);
  all[0] = 17;
  wire::put_big_endian(std::uint32_t{0x1E0A3B5C}, std::span(all).subspan(1));
  all[5] = node_;
  wire::put_big_endian(told_ms_, std::span(all).subspan(6));
  wire::put_big_endian(std::bit_cast<std::uint32_t>(brake_current_a_), std::span(all).subspan(10));
  for (std::size_t k = 14; k < all.size(); ++k) all[k] = static_cast<std::uint8_t>(k);
  const unsigned sum = crc(all, 16, 0x11021);  // x^16 + x^12 + x^5 + 1
  if (damaged_) all[8] ^= 1U;
  std::size_t at = 0;
  for (; at < 256; at += 7) {
    std::vector<std::uint8_t> piece{static_cast<std::uint8_t>(at)};
    for (std::size_t k = at; k < std::min(at + 7, all.size()); ++k) piece.push_back(all[k]);
    send(5, to, piece);
  }
  for (; at < all.size(); at += 6) {
    std::vector<std::uint8_t> piece{static_cast<std::uint8_t>(at >> 8U), static_cast<std::uint8_t>(at)};
    for (std::size_t k = at; k < std::min(at + 6, all.size()); ++k) piece.push_back(all[k]);
    send(6, to, piece);
  }
  std::vector<std::uint8_t> end;
  put(end, {{node_, 1}, {1, 1}, {kSettingsBytes >> 8U, 1}, {kSettingsBytes, 1}, {sum >> 8U, 1}, {sum, 1}});
  send(7, to, end);
}

void VescNode::move(double seconds) noexcept {
  const double before = erpm_;
  const bool lets_go = mode_ == Mode::kSpeed && std::fabs(target_erpm_) < minimum_erpm_;
  const Mode mode = fault_ != 0 || lets_go ? Mode::kCurrent : mode_;
  const double target = mode == Mode::kSpeed ? target_erpm_ : 0.0;
  erpm_ = ramped(erpm_, target, (mode == Mode::kCurrent ? kRollOut_erpm_per_s : kRamp_erpm_per_s) * seconds);
  position_ += 0.5 * (before + erpm_) / 60.0 * seconds;
}

void VescNode::say(Time now) noexcept {
  if (!is_due(said_, kPeriod, now)) return;
  std::array<std::uint8_t, 8> bytes{};
  const double felt = has_encoder_ ? 60.0 * encoder_velocity_ : erpm_;
  wire::put_big_endian(static_cast<std::uint32_t>(static_cast<std::int32_t>(felt)), bytes);
  send(9, node_, bytes);
  if (!tells_travel_) return;
  const auto sixths = static_cast<std::int64_t>(std::floor(6.0 * felt_position()));
  wire::put_big_endian(static_cast<std::uint32_t>(sixths), bytes);
  wire::put_big_endian(std::uint16_t{240}, std::span(bytes).subspan(4));
  send(27, node_, bytes);
}

void VescNode::restart() noexcept {
  mode_ = Mode::kCurrent;
  target_erpm_ = 0.0;
  forget();
}

std::string_view VescNode::state_name() const noexcept {
  if (fault_ != 0) return "fault";
  switch (mode_) {
    case Mode::kSpeed: return "enabled";
    case Mode::kBrake: return "braking";
    case Mode::kCurrent: break;
  }
  return "off";
}

void VescNode::send(std::uint32_t command, std::uint8_t id, std::span<const std::uint8_t> bytes) noexcept {
  CanFrame frame{.id = command << 8U | id, .extended = true, .size = static_cast<std::uint8_t>(bytes.size())};
  std::copy(bytes.begin(), bytes.end(), frame.bytes.begin());
  MotorNode::send(frame);
}

}  // namespace jaywalk::emulators
