#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "drivers/can/can_bus.h"

namespace jaywalk::emulators {

/// Emulated ARCOS board of a Pioneer: two motors with ramps, a report each cycle, encoders, settings, and a watchdog,
/// after which any packet resumes the last command. It shares no code with the driver. Speeds: mm/s; sides: 0 left, 1
/// right.
class ArcosBoard {
 public:
  /// `bus`, a place on the line, outlives it. `track_mm`: by which its wheels' speeds differ in a turn.
  ArcosBoard(CanBus& bus, double track_mm) noexcept : bus_(bus), track_mm_(track_mm) {}

  /// Takes what came in and moves the motors on to `now`.
  void step(Time now);

  /// 2000 ms from the factory.
  void set_watchdog(std::uint16_t ms) noexcept { watchdog_ms_ = ms; }
  /// 100 ms from the factory.
  void set_cycle(std::uint8_t ms) noexcept { cycle_ms_ = ms; }
  void set_ticks(std::uint16_t per_mm) noexcept { ticks_per_mm_ = per_mm; }
  void set_type(std::string type) { type_ = std::move(type); }
  /// No ramp can be set to more.
  void limit_ramps(std::uint16_t mmps2, std::uint16_t dps2) noexcept { ramp_limits_ = {mmps2, dps2}; }
  /// It knows no encoder packets, as a simulator.
  void withhold_encoders() noexcept { has_encoder_packets_ = false; }
  /// Coordinates and encoders begin there: they wrap.
  void begin_at(double x_mm, double position_mm) noexcept;
  void stall(std::size_t side, bool stalls) noexcept { motors_[side].stalls = stalls; }
  /// Its motors are off until they are enabled again.
  void press_stop(bool pressed) noexcept { stop_pressed_ = pressed, motors_on_ = motors_on_ && pressed; }
  /// The motors' supply is off: FLAGS bit 6.
  void stall_motors(bool stalls) noexcept { all_stall_ = stalls; }
  void switch_off_motors() noexcept { motors_on_ = false; }
  /// The motor goes on at its speed; an emergency stop and the watchdog brake it.
  void stick(std::size_t side) noexcept { motors_[side].sticks = true; }
  /// The same, but for the watchdog alone.
  void go_deaf(std::size_t side) noexcept { motors_[side].sticks = motors_[side].deaf = true; }
  /// Its encoder shows another way at once.
  void jump(std::size_t side, double mm) noexcept { motors_[side].jumped_mm += mm; }
  void mute() noexcept { muted_ = true; }
  void pull_cable() noexcept { connected_ = false; }
  void plug_cable() noexcept { connected_ = true; }
  /// Power lost and back: it is told nothing before a new connection.
  void restart() noexcept;
  /// What its encoders show from now on, where motors of the world's own follow velocity(): mm/s and mm.
  void measure(std::size_t side, double velocity, double position) noexcept;

  [[nodiscard]] double velocity(std::size_t side) const noexcept { return motors_[side].speed; }
  [[nodiscard]] double position(std::size_t side) const noexcept { return motors_[side].position; }
  [[nodiscard]] std::string_view state_name() const noexcept;
  /// When it heard a packet last; kNever before the first one.
  [[nodiscard]] Time heard_controller() const noexcept { return heard_; }
  [[nodiscard]] bool has_tripped() const noexcept { return tripped_; }
  [[nodiscard]] const std::vector<std::uint8_t>& commands() const noexcept { return commands_; }

 private:
  struct Motor {
    double speed = 0.0, position = 0.0;
    double shown_speed = 0.0, shown_position = 0.0, jumped_mm = 0.0;
    bool stalls = false, sticks = false, deaf = false;
  };
  /// Of speed or turn.
  struct Ramp {
    double now = 0.0, wanted = 0.0;
    double up = 300.0, down = 300.0, top = 750.0;
    void follow(double target, double hardest, double seconds) noexcept;
  };
  enum Way : std::size_t { kSpeed, kTurn };

  void hear(std::span<const std::uint8_t> bytes, Time now);
  void take(std::span<const std::uint8_t> body, Time now);
  void greet(std::uint8_t number);
  void obey(std::uint8_t number, std::int32_t argument);
  void set_ramp(Way way, std::int32_t argument) noexcept;
  void move(double seconds) noexcept;
  void turn_motor(Motor& motor, double target, double seconds) noexcept;
  void say_due(Time now);
  void say_report();
  void say_encoders();
  void say_settings();
  void say(std::vector<std::uint8_t> body);
  [[nodiscard]] bool runs() const noexcept { return motors_on_ && !stop_pressed_ && !all_stall_; }

  CanBus& bus_;
  double track_mm_;
  std::string type_ = "Pioneer";
  std::uint16_t watchdog_ms_ = 100, ticks_per_mm_ = 128;
  std::uint8_t cycle_ms_ = 100;
  std::array<std::uint16_t, 2> ramp_limits_{2000, 600};
  bool has_encoder_packets_ = true, connected_ = true, muted_ = false;
  std::vector<std::uint8_t> came_in_, commands_;
  std::uint8_t greeted_ = 0;  ///< SYNCs, in order; 3: all
  bool open_ = false, motors_on_ = false, tells_encoders_ = false, tripped_ = false, brakes_hard_ = false;
  bool stop_pressed_ = false, all_stall_ = false, has_encoder_ = false;
  std::array<Ramp, 2> ramps_{};
  std::array<Motor, 2> motors_{};
  double x_mm_ = 0.0, y_mm_ = 0.0, heading_rad_ = 0.0;
  Time stepped_ = kNever, heard_ = kNever, said_ = kNever;
};

}  // namespace jaywalk::emulators
