#include "hil/emulators/arcos_board.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "hal/types/trig.h"
#include "hil/emulators/byte_server.h"
#include "hil/emulators/motor_node.h"

namespace jaywalk::emulators {
namespace {

constexpr double kRollOut_mmps2 = 300.0;     ///< without torque
constexpr double kEmergency_mmps2 = 4000.0;  ///< by an emergency stop
constexpr double kDegree = kPi / 180.0;

/// Over each byte in turn, as high or low half of a sum.
std::uint16_t arcos_sum(std::span<const std::uint8_t> body) {
  std::uint32_t sum = 0;
  const std::size_t paired = body.size() - body.size() % 2;
  for (std::size_t k = 0; k < paired; ++k) sum += k % 2 == 0 ? body[k] * 256U : body[k];
  return static_cast<std::uint16_t>(paired < body.size() ? (sum & 0xFFFFU) ^ body.back() : sum);
}

void put_text(std::vector<std::uint8_t>& body, const std::string& text) {
  body.insert(body.end(), text.begin(), text.end());
  body.push_back(0);
}

}  // namespace

void ArcosBoard::Ramp::follow(double target, double hardest, double seconds) noexcept {
  const double ramp = std::fabs(target) < std::fabs(now) ? down : up;
  now = ramped(now, std::clamp(target, -top, top), std::max(ramp, hardest) * seconds);
}

void ArcosBoard::begin_at(double x_mm, double position_mm) noexcept {
  x_mm_ = x_mm;
  for (Motor& motor : motors_) motor.position = motor.shown_position = position_mm;
}

void ArcosBoard::restart() noexcept {
  const auto before = motors_;
  open_ = motors_on_ = tells_encoders_ = tripped_ = brakes_hard_ = muted_ = false;
  greeted_ = 0;
  ramps_ = {};
  for (std::size_t k = 0; k < 2; ++k) {
    motors_[k] = {.speed = before[k].speed, .position = before[k].position};
    motors_[k].jumped_mm = -before[k].shown_position;  // its counts begin anew
    motors_[k].shown_position = before[k].shown_position;
  }
}

void ArcosBoard::measure(std::size_t side, double velocity, double position) noexcept {
  has_encoder_ = true;
  motors_[side].shown_speed = velocity;
  motors_[side].shown_position = position;
}

std::string_view ArcosBoard::state_name() const noexcept {
  if (stop_pressed_ || all_stall_) return "fault";
  if (tripped_) return "tripped";
  return motors_on_ ? "enabled" : "off";
}

void ArcosBoard::step(Time now) {
  ReceivedFrame received;
  while (bus_.receive(received))
    if (connected_) hear(received.frame.payload(), now);
  tripped_ = tripped_ || (open_ && watchdog_ms_ > 0 && now - heard_ > std::chrono::milliseconds(watchdog_ms_));
  if (stepped_ != kNever) move(to_seconds(now - stepped_));
  stepped_ = now;
  if (open_) say_due(now);
}

void ArcosBoard::hear(std::span<const std::uint8_t> bytes, Time now) {
  came_in_.insert(came_in_.end(), bytes.begin(), bytes.end());
  while (came_in_.size() >= 3) {
    const bool begins = came_in_[0] == 0xFA && came_in_[1] == 0xFB && came_in_[2] >= 3;
    const std::size_t whole = begins ? std::size_t{3} + came_in_[2] : 1;
    if (came_in_.size() < whole) return;
    const std::vector<std::uint8_t> packet(came_in_.begin(), came_in_.begin() + static_cast<std::ptrdiff_t>(whole));
    const auto body = std::span(packet).subspan(std::min<std::size_t>(whole, 3)).first(begins ? whole - 5 : 0);
    const bool sound = begins && arcos_sum(body) == packet[whole - 2] * 256U + packet[whole - 1];
    came_in_.erase(came_in_.begin(), came_in_.begin() + (sound ? static_cast<std::ptrdiff_t>(whole) : 1));
    if (sound) take(body, now);
  }
}

void ArcosBoard::take(std::span<const std::uint8_t> body, Time now) {
  heard_ = now;
  commands_.push_back(body[0]);
  if (!open_) return greet(body[0]);
  tripped_ = false;  // and what it was told before it tripped holds again
  const bool has_argument = body.size() >= 4;
  const std::int32_t size = has_argument ? body[2] + 256 * body[3] : 0;
  obey(body[0], has_argument && body[1] == 0x1B ? -size : size);
}

void ArcosBoard::greet(std::uint8_t number) {
  if (greeted_ == 3 && number == 1) {
    open_ = true;
    return;
  }
  if (number == 0) greeted_ = 0;
  if (number != greeted_ || number > 2) return;
  ++greeted_;
  std::vector<std::uint8_t> echo{number};
  if (number == 2) {
    put_text(echo, "Bench");
    put_text(echo, type_);
    put_text(echo, "p3dx-sh");
  }
  say(echo);
}

void ArcosBoard::obey(std::uint8_t number, std::int32_t argument) {
  switch (number) {
    case 2:
      open_ = motors_on_ = tells_encoders_ = false;
      greeted_ = 0;
      return;
    case 4: motors_on_ = argument != 0 && !stop_pressed_; return;
    case 5: return set_ramp(kSpeed, argument);
    case 6: ramps_[kSpeed].top = argument; return;
    case 10: ramps_[kTurn].top = argument; return;
    case 11:
    case 21:
      ramps_[number == 11 ? kSpeed : kTurn].wanted = argument;
      brakes_hard_ = false;
      return;
    case 18: return say_settings();
    case 19: tells_encoders_ = argument > 1 && has_encoder_packets_; return;
    case 23: return set_ramp(kTurn, argument);
    case 29:
    case 55:
      for (Ramp& ramp : ramps_) ramp.wanted = 0.0;
      brakes_hard_ = number == 55;
      return;
    default: return;
  }
}

void ArcosBoard::set_ramp(Way way, std::int32_t argument) noexcept {
  const double set = std::min<std::int32_t>(std::abs(argument), ramp_limits_[way]);
  (argument < 0 ? ramps_[way].down : ramps_[way].up) = set;
}

void ArcosBoard::move(double seconds) noexcept {
  const bool follows = runs() && !tripped_;
  const double hardest = brakes_hard_ ? kEmergency_mmps2 : 0.0;
  for (Ramp& ramp : ramps_) ramp.follow(follows ? ramp.wanted : 0.0, hardest, seconds);
  const double half = 0.5 * ramps_[kTurn].now * kDegree * track_mm_;
  turn_motor(motors_[0], ramps_[kSpeed].now - half, seconds);
  turn_motor(motors_[1], ramps_[kSpeed].now + half, seconds);
  const double way = 0.5 * (motors_[0].shown_speed + motors_[1].shown_speed) * seconds;
  x_mm_ += way * jaywalk::cos(heading_rad_);
  y_mm_ += way * jaywalk::sin(heading_rad_);
  heading_rad_ += (motors_[1].shown_speed - motors_[0].shown_speed) / track_mm_ * seconds;
}

void ArcosBoard::turn_motor(Motor& motor, double target, double seconds) noexcept {
  const double before = motor.speed;
  const bool braked = tripped_ || (brakes_hard_ && !motor.deaf);
  if (!motors_on_ || motor.stalls)
    motor.speed = ramped(before, 0.0, (motor.stalls ? kEmergency_mmps2 : kRollOut_mmps2) * seconds);
  else if (!motor.sticks)
    motor.speed = target;
  else if (braked)
    motor.speed = ramped(before, 0.0, ramps_[kSpeed].down * seconds);
  motor.position += 0.5 * (before + motor.speed) * seconds;
  if (has_encoder_) return;
  motor.shown_speed = motor.speed;
  motor.shown_position = motor.position;
}

void ArcosBoard::say_due(Time now) {
  if (!is_due(said_, std::chrono::milliseconds(cycle_ms_), now)) return;
  say_report();
  if (tells_encoders_) say_encoders();
}

void ArcosBoard::say_report() {
  const bool moves = motors_[0].shown_speed != 0.0 || motors_[1].shown_speed != 0.0;
  std::vector<std::uint8_t> body{static_cast<std::uint8_t>(moves ? 0x33 : 0x32)};
  const auto heading = std::llround(heading_rad_ * 4096.0 / (2.0 * kPi));
  put(body, {{std::llround(x_mm_), 2}, {std::llround(y_mm_), 2}, {heading, 2}});
  for (const Motor& motor : motors_) put(body, std::llround(motor.shown_speed), 2);
  const int stalls = (motors_[0].stalls ? 1 : 0) + (motors_[1].stalls ? 256 : 0);
  const int flags = (runs() ? 1 : 0) + (stop_pressed_ ? 32 : 0) + (all_stall_ ? 64 : 0);
  put(body, {{125, 1}, {stalls, 2}, {0, 2}, {flags, 2}, {0, 2}, {125, 7}});  // battery, 0.1 V; compass, no sonar
  say(std::move(body));
}

void ArcosBoard::say_encoders() {
  std::vector<std::uint8_t> body{0x90};
  for (const Motor& motor : motors_)
    put(body, std::llround((motor.shown_position + motor.jumped_mm) * ticks_per_mm_), 4);
  say(std::move(body));
}

void ArcosBoard::say_settings() {
  std::vector<std::uint8_t> body{0x20};
  put_text(body, type_);
  put_text(body, "p3dx-sh");
  put_text(body, "SERIAL");
  put(body, 0, 1);
  for (const int top : {500, 1500, int{ramp_limits_[kTurn]}, int{ramp_limits_[kSpeed]}, 500}) put(body, top, 2);
  put_text(body, "Bench");
  put(body, {{cycle_ms_, 1}, {0, 9}, {16570, 2}, {watchdog_ms_, 2}, {0, 9}});  // 16570: ticks of a turn
  for (const Ramp* ramp : {&ramps_[kTurn], &ramps_[kSpeed]}) put(body, std::llround(ramp->top), 2);
  for (const Ramp* ramp : {&ramps_[kTurn], &ramps_[kSpeed]})
    put(body, {{std::llround(ramp->up), 2}, {std::llround(ramp->down), 2}, {0, 6}});  // no gains
  put(body, {{0, 10}, {ticks_per_mm_, 2}, {105, 2}});
  put_text(body, "2.5");
  say(std::move(body));
}

void ArcosBoard::say(std::vector<std::uint8_t> body) {
  if (!connected_ || muted_) return;
  const std::uint16_t sum = arcos_sum(body);
  body.insert(body.begin(), {0xFA, 0xFB, static_cast<std::uint8_t>(body.size() + 2)});
  body.push_back(static_cast<std::uint8_t>(sum >> 8U));
  body.push_back(static_cast<std::uint8_t>(sum));
  in_frames(body, [this](const CanFrame& frame) { static_cast<void>(bus_.send(frame)); });
}

}  // namespace jaywalk::emulators
