#include "drivers/panel/joystick.h"

#include <fcntl.h>
#include <linux/input.h>
#include <linux/joystick.h>
#include <pthread.h>
#include <sched.h>
#include <sys/ioctl.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <span>
#include <string_view>

#include "drivers/wire/thread_without_signals.h"

namespace jaywalk::panel {
namespace {

constexpr Duration kBetweenTries = std::chrono::milliseconds(500);
constexpr double kDeadZone = 0.1;  ///< worn sticks come to rest up to here
constexpr int kMostReads = 8;

/// <linux/input.h>'s EVIOCGKEY (18h), EVIOCGBIT (20h and the type of event) and EVIOCGABS (40h and the axis), without
/// their mixed signs.
constexpr unsigned long question(unsigned number, std::size_t answer_bytes) noexcept {
  return _IOC(_IOC_READ, 0x45U, number, static_cast<unsigned>(answer_bytes));  // 45h: 'E'
}

/// <linux/joystick.h>'s JSIOCGBUTTONS, without its mixed signs.
constexpr unsigned long kHowManyButtons = _IOC(_IOC_READ, 0x6AU, 0x12U, 1U);  // 6Ah: 'j'

template <std::size_t N>
bool has(const std::array<std::uint8_t, N>& bits, std::uint16_t code) noexcept {
  return code / 8U < N && (static_cast<unsigned>(bits[code / 8U]) >> (code % 8U) & 1U) != 0;
}

/// Key of the first button or stick that a setup needs and the device lacks; empty where it has them all.
std::string_view lacking_key(const DeviceKeys& keys, const JoystickSetup& setup) noexcept {
  if (!keys.answers || !has(keys.buttons, setup.stop)) return "stop_button";
  if (setup.needs_dead_man && !has(keys.buttons, setup.dead_man)) return "dead_man_button";
  const bool has_stick = has(keys.axes, setup.forward) && has(keys.axes, setup.left);
  return setup.steers && !has_stick ? "steering" : "";
}

}  // namespace

double Joystick::Axis::share() const noexcept {
  const double middle = 0.5 * (static_cast<double>(least) + most);
  const double half = 0.5 * (static_cast<double>(most) - least);
  const double raw = half > 0.0 ? std::clamp((value - middle) / half, -1.0, 1.0) : 0.0;
  const double beyond = (std::fabs(raw) - kDeadZone) / (1.0 - kDeadZone);
  return beyond > 0.0 ? std::copysign(beyond, raw) : 0.0;
}

std::optional<std::uint16_t> bus_of(int device) noexcept {
  input_id told{};
  if (::ioctl(device, question(0x02, sizeof told), &told) < 0) return std::nullopt;  // EVIOCGID
  return told.bustype;
}

void Joystick::poll(Time now) noexcept {
  if (device_.get() < 0 && (tried_ == kNever || now - tried_ >= kBetweenTries)) {
    tried_ = now;
    open();
  }
  read();
  expire_dead_man(now);
  note_centred();
  count_stop();
}

/// A dead man whose time is up counts as one that was never seen released.
void Joystick::expire_dead_man(Time now) noexcept {
  if (heard_) heard_at_ = now;
  heard_ = false;
  if (setup_.dead_man_renew > Duration{0} && age(heard_at_, now) > setup_.dead_man_renew &&
      dead_man_ == Button::kPressed)
    seen_released_ = false;
}

void Joystick::note_centred() noexcept {
  const bool centred = forward_.share() == 0.0 && left_.share() == 0.0;
  seen_centred_ = is_held() && (seen_centred_ || centred);
}

bool Joystick::is_held() const noexcept {
  const bool needs_renewal = on_bluetooth_ && setup_.dead_man_renew == Duration{0};
  return dead_man_ == Button::kPressed && seen_released_ && !needs_renewal;
}

bool Joystick::stops() const noexcept {
  if (device_.get() < 0) return true;
  return setup_.stop_opens ? stop_ != Button::kPressed : stop_ == Button::kPressed;
}

void Joystick::count_stop() noexcept {
  const bool stop = stops();
  if (stop && !stopped_before_) ++stops_;
  stopped_before_ = stop;
}

JoystickState Joystick::state() const noexcept {
  if (device_.get() < 0) return {.stops = stops_};
  const bool steers = is_held() && seen_centred_;
  return {.connected = true,
          .dead_man = is_held(),
          .stop = stops(),
          .stops = stops_,
          .reset = reset_ == Button::kPressed,
          .needs_renewal = on_bluetooth_ && setup_.dead_man_renew == Duration{0},
          .forward = steers ? -forward_.share() : 0.0,
          .left = steers ? -left_.share() : 0.0};
}

void Joystick::open() noexcept {
  device_ = wire::FileDescriptor(::open(setup_.path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
  dead_man_ = stop_ = reset_ = Button::kUnknown;
  seen_released_ = false;
  forward_ = left_ = Axis();
  if (device_.get() < 0) return;
  if (setup_.asks_device && !lacking_key(keys_of(device_.get()), setup_).empty()) return close();
  on_bluetooth_ = ask_bus_(device_.get()) == BUS_BLUETOOTH;
  ask_present_state();
}

/// Events tell changes; how things stand must be asked for. What is no device does not answer.
void Joystick::ask_present_state() noexcept {
  std::array<std::uint8_t, KEY_MAX / 8 + 1> keys{};
  if (::ioctl(device_.get(), question(0x18, keys.size()), keys.data()) >= 0) {
    for (const std::uint16_t code : {setup_.dead_man, setup_.stop, setup_.reset})
      if (code <= KEY_MAX) take_button(code, has(keys, code));
  }
  const auto ask_axis = [this](std::uint16_t code, Axis& axis) {
    input_absinfo told{};
    if (code > ABS_MAX || ::ioctl(device_.get(), question(0x40U + code, sizeof told), &told) < 0) return;
    axis = {told.minimum, told.maximum, told.value};
  };
  ask_axis(setup_.forward, forward_);
  ask_axis(setup_.left, left_);
}

// The kernel hands out whole events only.
void Joystick::read() noexcept {
  std::array<input_event, 64> events;
  for (int k = 0; k < kMostReads && device_.get() >= 0; ++k) {
    const ssize_t count = ::read(device_.get(), events.data(), sizeof events);
    if (count <= 0) {
      if (count == 0 || (errno != EAGAIN && errno != EINTR)) close();
      return;
    }
    const std::size_t whole = static_cast<std::size_t>(count) / sizeof(input_event);
    for (const input_event& event : std::span(events).first(whole)) take(event);
  }
}

void Joystick::take(const input_event& event) noexcept {
  if (event.type == EV_SYN && event.code == SYN_DROPPED) return close();  // events are lost: ask again how things stand
  heard_ = heard_ || event.type == EV_KEY || event.type == EV_ABS;
  if (event.type == EV_KEY) take_button(event.code, event.value != 0);
  if (event.type == EV_ABS && event.code == setup_.forward) forward_.value = event.value;
  if (event.type == EV_ABS && event.code == setup_.left) left_.value = event.value;
}

void Joystick::take_button(std::uint16_t code, bool pressed) noexcept {
  const Button now = pressed ? Button::kPressed : Button::kReleased;
  if (code == setup_.dead_man) {
    dead_man_ = now;
    seen_released_ = seen_released_ || !pressed;
  }
  if (code == setup_.stop) stop_ = now;
  count_stop();
  if (code == setup_.reset) reset_ = now;
}

DeviceKeys keys_of(int device) noexcept {
  DeviceKeys keys;
  std::uint8_t buttons = 0;
  keys.old_joystick = ::ioctl(device, kHowManyButtons, &buttons) >= 0;
  keys.answers = ::ioctl(device, question(0x20U + EV_KEY, keys.buttons.size()), keys.buttons.data()) >= 0;
  static_cast<void>(::ioctl(device, question(0x20U + EV_ABS, keys.axes.size()), keys.axes.data()));
  return keys;
}

std::string lacking(const DeviceKeys& keys, const JoystickSetup& setup) {
  const std::string_view key = lacking_key(keys, setup);
  if (key.empty()) return "";
  if (keys.old_joystick) return "speaks the older joystick interface, whose buttons have no numbers of their own";
  if (!keys.answers) return "is no input device: it does not tell which buttons it has";
  if (key == "steering") return "has no stick, which [panel] steering needs";
  const std::uint16_t code = key == "stop_button" ? setup.stop : setup.dead_man;
  return "has no button " + std::to_string(code) + ", which [panel] " + std::string(key) + " names";
}

JoystickWatch::~JoystickWatch() {
  ending_ = true;
  if (thread_.joinable()) thread_.join();
}

void JoystickWatch::start(int priority) {
  thread_ = thread_without_signals("joystick", [this] {
    for (; !ending_; clock_.sleep_until(clock_.now() + kPeriod)) step();
  });
  const sched_param wanted{.sched_priority = priority};
  if (priority > 0) ::pthread_setschedparam(thread_.native_handle(), SCHED_FIFO, &wanted);
}

void JoystickWatch::step() noexcept {
  const Time now = clock_.now();  // before it looks: what blocks there makes the report old
  joystick_.poll(now);
  reports_.publish({joystick_.state(), now});
}

JoystickState JoystickWatch::latest() noexcept {
  const Report& report = reports_.latest();
  if (age(report.looked, clock_.now()) <= kLongestAge) return report.state;
  return {.stops = report.state.stops};
}

OperatorInput JoystickPanel::latest() noexcept {
  OperatorInput input = goals_.latest();
  const JoystickState joystick = joystick_.latest();
  const bool stopped_meanwhile = joystick.stops != std::exchange(stops_, joystick.stops);
  input.emergency_stop = input.emergency_stop || joystick.stop || stopped_meanwhile;
  input.reset = input.reset || joystick.reset;
  if (needs_dead_man_ && !joystick.dead_man) input.has_goal = false;
  if (!stick_drives_) return input;
  input.stick = {joystick.forward, joystick.left};
  input.steers = !input.stick.is_centred() || !input.has_goal;
  if (input.steers) input.has_goal = false;
  return input;
}

}  // namespace jaywalk::panel
