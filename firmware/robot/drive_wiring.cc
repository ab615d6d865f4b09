#include "firmware/robot/drive_wiring.h"

#include <algorithm>
#include <cmath>

#include "firmware/robot/robot_file.h"

namespace jaywalk {
namespace {

constexpr std::size_t kMostLetters = 16;  ///< IFNAMSIZ: of a network interface's name and its end

/// The drives' own ramps lie above what the controller asks for, or they would lag behind it; the proof of 6084h and
/// 6085h then covers limits.brake_mps2.
constexpr double kRampOverBrake = 1.5;

// Pioneer 3 Operations Manual: from the factory.
constexpr std::uint16_t kArcosPort = 8101;
constexpr std::uint32_t kArcosBaud = 9600;
constexpr double kArcosCycle_s = 0.1;

/// Wheel acceleration (m/s2 at the rim) as counts/s2.
std::uint32_t ramp(double mps2, const DriveModel& model, double counts_per_rad) {
  constexpr double kMost = 4294967295.0;
  return static_cast<std::uint32_t>(std::fmin(mps2 / model.wheel_radius_m * counts_per_rad + 0.5, kMost));
}

/// Left, right; the model's where the file has none.
std::array<double, 2> read_radii(TomlTable& table, const DriveModel& model) {
  return {table.number("left_wheel_radius_m", model.wheel_radius_m),
          table.number("right_wheel_radius_m", model.wheel_radius_m)};
}

/// What a radian of a wheel as large as the model's is in the drive's own unit, `per_rad` of them a radian of its own.
/// A larger wheel turns less for the same way.
std::array<double, 2> scaled(TomlTable& table, double per_rad, const DriveModel& model) {
  std::array<double, 2> scales = read_radii(table, model);
  for (double& scale : scales) scale = per_rad * model.wheel_radius_m / scale;
  return scales;
}

/// The same of `key` units a turn; negative for a motor that is reversed.
std::array<double, 2> read_scales(TomlTable& table, const std::string& key, const DriveModel& model) {
  std::array<double, 2> scales = scaled(table, table.number(key) / (2.0 * kPi), model);
  if (table.boolean("left_reversed")) scales[0] = -scales[0];
  if (table.boolean("right_reversed")) scales[1] = -scales[1];
  return scales;
}

/// What every stop is held against: the model's braking, at the wheels.
StopLimits stop_limits_of(const RobotModel& model, Duration tick) {
  constexpr double kTolerance_mps = 0.05;  // above what a VESC's speed scatters by at rest
  const double radius_m = model.drive.wheel_radius_m;
  return stop_limits(model.limits.brake_mps2 / radius_m, kTolerance_mps / radius_m, tick, model.drive.times);
}

/// Raises `least`, the shortest timeout, to two of the loop's periods; refuses a loop of which those exceed `most`.
void outlast_two_ticks(TomlTable& table, Duration tick, Duration most, const std::string& what, Duration& least) {
  least = std::max(least, 2 * tick);
  if (2 * tick <= most) return;
  table.refuse("kind",
               "needs " + what + " of at most " + std::to_string(most / std::chrono::milliseconds(1)) +
                   " ms, less than two of the loop's periods",
               "raise rate_hz");
}

/// Two motor controllers, one a wheel.
template <typename Base>
void read_axes(TomlTable& table, const std::string& key, const DriveModel& model, const StopLimits& stop, Base& base) {
  const auto scales = read_scales(table, key, model);
  require_distinct(table, {"left_node", "right_node"});
  base.axes = {CanAxis{static_cast<std::uint8_t>(table.integer("left_node")), scales[0]},
               CanAxis{static_cast<std::uint8_t>(table.integer("right_node")), scales[1]}};
  base.allow_unproved = table.boolean("allow_unproved");
  base.stop = stop;
}

canopen::DriveBaseSetup read_cia402(TomlTable& table, const RobotModel& model, Duration tick, const StopLimits& stop) {
  canopen::DriveBaseSetup base;
  canopen::DriveSettings& settings = base.settings;
  canopen_keys().read(table, settings);
  if (2 * tick > std::chrono::milliseconds(settings.controller_timeout_ms)) {
    table.refuse("controller_timeout_ms",
                 "is " + std::to_string(settings.controller_timeout_ms) + ", less than two of the loop's periods",
                 "raise it, or rate_hz");
  }
  base.silence_limit = 3 * std::chrono::milliseconds(settings.heartbeat_ms);
  read_axes(table, "counts_per_wheel_turn", model.drive, stop, base);
  require_distinct(table, {"left_node", "right_node", "controller_node"});
  settings.acceleration = settings.deceleration = settings.quick_stop =
      ramp(kRampOverBrake * model.limits.brake_mps2, model.drive, std::fabs(base.axes[0].per_rad));
  return base;
}

double seconds_of(TomlTable& table, const char* key, double otherwise_s) {
  return 1e-3 * table.number(key, 1e3 * otherwise_s);
}

/// CANopen drives answer the loop's SYNC, ODrive and VESC report at 50 Hz or more, the others as often as the file
/// says.
DriveTimes read_times(TomlTable& table, DriveKind kind, Duration tick) {
  DriveTimes times;
  times.response_s = seconds_of(table, "response_ms", times.response_s);
  if (kind == DriveKind::kCia402) times.report_s = std::max(times.report_s, to_seconds(tick));
  if (kind != DriveKind::kDds && kind != DriveKind::kPioneer) return times;
  times.report_s = seconds_of(table, "report_ms", kind == DriveKind::kDds ? to_seconds(tick) : kArcosCycle_s);
  times.late_s = seconds_of(table, "report_late_ms", times.late_s);
  return times;
}

ros::BaseSetup read_ros(TomlTable& table, Duration tick, const DriveTimes& times, const StopLimits& stop) {
  return {.odometry = read_topic(table, "odometry", ros::BaseSetup{}.odometry),
          .command = read_topic(table, "command", ros::BaseSetup{}.command),
          .stamped = table.boolean("stamped"),
          .reliable = table.boolean("reliable"),
          .stop = stop,
          .allow_unproved = table.boolean("allow_unproved"),
          .tick = tick,
          .times = times};
}

arcos::BaseSetup read_arcos(TomlTable& table, const RobotModel& model, Duration tick, const StopLimits& stop) {
  constexpr double kDegrees = 180.0 / kPi, kMost = 32767.0;
  const double ramp_mmps2 = kRampOverBrake * 1000.0 * model.limits.brake_mps2;
  const double track_mm = 1000.0 * model.drive.track_width_m;
  const auto whole = [](double value) { return static_cast<std::int16_t>(std::fmin(std::ceil(value), kMost)); };
  arcos::BaseSetup base;
  outlast_two_ticks(table, tick, base.watchdog_most, "a watchdog", base.watchdog_least);
  base.mm_per_rad = scaled(table, 1000.0 * model.drive.wheel_radius_m, model.drive);
  base.track_mm = track_mm;
  base.ticks_per_mm = static_cast<int>(table.integer("ticks_per_mm"));
  base.motion = {whole(ramp_mmps2), whole(2.0 * ramp_mmps2 / track_mm * kDegrees),
                 whole(1000.0 * model.limits.max_speed_mps), whole(kDegrees * model.limits.max_turn_radps)};
  base.stop = stop;
  base.allow_unproved = table.boolean("allow_unproved");
  base.tick = tick;
  base.times = model.drive.times;
  return base;
}

std::string read_interface(TomlTable& table) {
  std::string can = table.text("can");
  if (can.empty() || can.size() >= kMostLetters || can.find_first_of("/ ") != std::string::npos)
    table.refuse("can", "is no interface's name", "give the one that ip link shows, at most 15 letters");
  return can;
}

}  // namespace

ByteWiring read_byte_wiring(TomlTable& table, const std::string& what, std::uint16_t makers_port,
                            std::uint32_t makers_baud) {
  ByteWiring wiring;
  if (table.has("host") && table.has("device"))
    table.refuse("device", "stands beside host", "keep the one by which this " + what + " is connected");
  if (makers_port == 0 || (makers_baud != 0 && table.has("device"))) {
    if (table.has("host"))
      table.refuse("host", "is for " + what + "s on the network", "give the serial line of this one as device");
    wiring.device = table.text("device");
    wiring.baud = static_cast<std::uint32_t>(table.integer("baud", makers_baud));
    return wiring;
  }
  if (table.has("device"))
    table.refuse("device", "is for " + what + "s on a serial line", "give the address of this one as host");
  wiring.host = table.text("host");
  wiring.port = static_cast<std::uint16_t>(table.integer("port", makers_port));
  return wiring;
}

std::string name_of(const ByteWiring& wiring) {
  return wiring.host.empty() ? wiring.device : wiring.host + ":" + std::to_string(wiring.port);
}

std::array<CanAxis, 2> DriveWiring::axes() const noexcept {
  switch (kind) {
    case DriveKind::kCia402: return cia402.axes;
    case DriveKind::kOdrive: return odrive.axes;
    case DriveKind::kVesc: return vesc.axes;
    case DriveKind::kDds: break;
    case DriveKind::kPioneer: return {CanAxis{0, arcos.mm_per_rad[0]}, CanAxis{0, arcos.mm_per_rad[1]}};
  }
  return {CanAxis{0, 1.0}, CanAxis{0, 1.0}};
}

DriveWiring read_drive(TomlTable table, RobotModel& model, Duration tick) {
  DriveWiring wiring;
  wiring.kind = static_cast<DriveKind>(table.choose_keys("kind"));  // the choices are in the enumeration's order
  model.drive.times = read_times(table, wiring.kind, tick);
  const StopLimits stop = stop_limits_of(model, tick);
  model.drive.track_width_m = table.number("track_width_m", model.drive.track_width_m);
  if (wiring.is_on_can()) wiring.can = read_interface(table);
  wiring.wheel_radii_m = {model.drive.wheel_radius_m, model.drive.wheel_radius_m};  // of a ROS 2 base, too
  if (wiring.kind != DriveKind::kDds) wiring.wheel_radii_m = read_radii(table, model.drive);
  switch (wiring.kind) {
    case DriveKind::kCia402: wiring.cia402 = read_cia402(table, model, tick, stop); break;
    case DriveKind::kOdrive:
      outlast_two_ticks(table, tick, wiring.odrive.watchdog_limit, "a watchdog", wiring.odrive.watchdog_least);
      read_axes(table, "motor_turns_per_wheel_turn", model.drive, stop, wiring.odrive);
      break;
    case DriveKind::kVesc:
      outlast_two_ticks(table, tick, wiring.vesc.timeout_most, "a timeout", wiring.vesc.timeout_least);
      read_axes(table, "electrical_turns_per_wheel_turn", model.drive, stop, wiring.vesc);
      break;
    case DriveKind::kDds:
      wiring.ros = read_ros(table, tick, model.drive.times, stop);
      wiring.can = wiring.ros.command;
      break;
    case DriveKind::kPioneer:
      wiring.line = read_byte_wiring(table, "base", kArcosPort, kArcosBaud);
      wiring.can = name_of(wiring.line);
      wiring.arcos = read_arcos(table, model, tick, stop);
      wiring.arcos.name = wiring.can;
      break;
  }
  table.finish();
  return wiring;
}

}  // namespace jaywalk
