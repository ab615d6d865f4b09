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
#include <cstring>

#include "drivers/wire/thread_without_signals.h"

namespace jaywalk::panel {
namespace {

constexpr Duration kBetweenTries = std::chrono::milliseconds(500);
constexpr double kDeadZone = 0.1;  ///< worn sticks come to rest up to here
constexpr int kMostReads = 8;

/// <linux/input.h>'s EVIOCGKEY (18h) and EVIOCGABS (40h and the axis), without their mixed signs.
constexpr unsigned long question(unsigned number, std::size_t answer_bytes) noexcept {
  return _IOC(_IOC_READ, 0x45U, number, static_cast<unsigned>(answer_bytes));  // 45h: 'E'
}

/// <linux/input.h>'s EVIOCGBIT: 20h and the type of event.
constexpr unsigned long which_codes(unsigned type, std::size_t bytes) noexcept {
  return _IOC(_IOC_READ, 0x45U, 0x20U + type, static_cast<unsigned>(bytes));  // 45h: 'E'
}
/// <linux/joystick.h>'s JSIOCGBUTTONS, without its mixed signs.
constexpr unsigned long kHowManyButtons = _IOC(_IOC_READ, 0x6AU, 0x12U, 1U);  // 6Ah: 'j'

template <std::size_t N>
bool has(const std::array<std::uint8_t, N>& bits, std::uint16_t code) noexcept {
  return code / 8U < N && (static_cast<unsigned>(bits[code / 8U]) >> (code % 8U) & 1U) != 0;
}

bool has_stick(const DeviceKeys& keys, const JoystickSetup& setup) noexcept {
  return has(keys.axes, setup.forward) && has(keys.axes, setup.left);
}

}  // namespace

std::optional<InputEvent> EventStream::next() noexcept {
  input_event raw;
  const wire::Bytes waiting = queue_.waiting();
  if (waiting.size() < sizeof raw) return std::nullopt;
  std::memcpy(&raw, waiting.data(), sizeof raw);
  queue_.drop(sizeof raw);
  return InputEvent{raw.type, raw.code, raw.value};
}

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
  JoystickState gone;
  gone.stops = stops_;
  if (device_.get() < 0) return gone;
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
  events_.forget();
  dead_man_ = stop_ = reset_ = Button::kUnknown;
  seen_released_ = false;
  forward_ = left_ = Axis();
  if (device_.get() < 0) return;
  if (setup_.asks_device && !has_all(keys_of(device_.get()), setup_)) return close();
  on_bluetooth_ = ask_bus_(device_.get()) == BUS_BLUETOOTH;
  ask_present_state();
}

/// Events tell changes; how things stand must be asked for. What is no device does not answer.
void Joystick::ask_present_state() noexcept {
  std::array<std::uint8_t, KEY_MAX / 8 + 1> keys{};
  if (::ioctl(device_.get(), question(0x18, keys.size()), keys.data()) >= 0) {
    for (const std::uint16_t code : {setup_.dead_man, setup_.stop, setup_.reset})
      if (code <= KEY_MAX) take_button(code, ((static_cast<unsigned>(keys[code / 8U]) >> (code % 8U)) & 1U) != 0);
  }
  const auto ask_axis = [this](std::uint16_t code, Axis& axis) {
    input_absinfo told{};
    if (code > ABS_MAX || ::ioctl(device_.get(), question(0x40U + code, sizeof told), &told) < 0) return;
    axis = {told.minimum, told.maximum, told.value};
  };
  ask_axis(setup_.forward, forward_);
  ask_axis(setup_.left, left_);
}

void Joystick::read() noexcept {
  for (int k = 0; k < kMostReads && device_.get() >= 0; ++k) {
    const ssize_t count = ::read(device_.get(), room_.data(), room_.size());
    if (count <= 0) {
      if (count == 0 || (errno != EAGAIN && errno != EINTR)) close();
      return;
    }
    events_.append(wire::Bytes(room_).first(static_cast<std::size_t>(count)));
    while (const auto event = events_.next()) take(*event);
  }
}

void Joystick::take(const InputEvent& event) noexcept {
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
  keys.answers = ::ioctl(device, which_codes(EV_KEY, keys.buttons.size()), keys.buttons.data()) >= 0;
  static_cast<void>(::ioctl(device, which_codes(EV_ABS, keys.axes.size()), keys.axes.data()));
  return keys;
}

bool has_all(const DeviceKeys& keys, const JoystickSetup& setup) noexcept {
  const bool stops = keys.answers && has(keys.buttons, setup.stop);
  return stops && (!setup.needs_dead_man || has(keys.buttons, setup.dead_man)) &&
         (!setup.steers || has_stick(keys, setup));
}

std::string lacking(const DeviceKeys& keys, const JoystickSetup& setup) {
  if (has_all(keys, setup)) return "";
  if (keys.old_joystick) return "speaks the older joystick interface, whose buttons have no numbers of their own";
  if (!keys.answers) return "is no input device: it does not tell which buttons it has";
  const auto button = [](const char* key, std::uint16_t code) {
    return "has no button " + std::to_string(code) + ", which [panel] " + key + " names";
  };
  if (!has(keys.buttons, setup.stop)) return button("stop_button", setup.stop);
  if (setup.needs_dead_man && !has(keys.buttons, setup.dead_man)) return button("dead_man_button", setup.dead_man);
  return "has no stick, which [panel] steering needs";
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
  JoystickState gone;
  gone.stops = report.state.stops;
  return gone;
}

OperatorInput JoystickPanel::latest() noexcept {
  OperatorInput input = goals_.latest();
  const std::uint32_t stops_before = state_.stops;
  state_ = joystick_.latest();
  const bool stopped_meanwhile = state_.stops != stops_before;
  input.emergency_stop = input.emergency_stop || state_.stop || stopped_meanwhile;
  input.reset = input.reset || state_.reset;
  if (needs_dead_man_ && !state_.dead_man) input.has_goal = false;
  if (!stick_drives_) return input;
  input.stick = {state_.forward, state_.left};
  input.steers = !input.stick.is_centred() || !input.has_goal;
  if (input.steers) input.has_goal = false;
  return input;
}

}  // namespace jaywalk::panel
