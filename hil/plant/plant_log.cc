#include "hil/plant/plant_log.h"

#include <cmath>
#include <cstdio>

#include "hal/types/errors.h"

namespace jaywalk::rig {
namespace {

constexpr double kMoves_mps = 0.005;  ///< a wheel that turns faster is under way; at 0 it is at rest

template <class... Values>
std::string text(const char* format, Values... values) {
  char line[200];
  std::snprintf(line, sizeof line, format, values...);
  return line;
}

}  // namespace

PlantLog::PlantLog(const std::filesystem::path& file, Time start) : file_(file), start_(start) {
  if (!file_) throw StartupError(file.string() + ": cannot be written", "give --log a file that can");
  event(start, "ready");
}

void PlantLog::event(Time now, const std::string& words) {
  file_ << text("%.3f ", to_seconds(now - start_)) << words << std::endl;
}

void PlantLog::late(Time now, Duration by) { event(now, text("late by %.0f ms", 1e3 * to_seconds(by))); }

void PlantLog::follow(SimulatedRobot& robot, Time now) {
  for (std::size_t side = 0; side < 2; ++side) follow_drive(robot, side, now);
  follow_motion(robot, now);
}

void PlantLog::follow_drive(SimulatedRobot& robot, std::size_t side, Time now) {
  const WheelDrive& drive = robot.drive(side);
  if (drive.heard_controller() != kNever && drive.heard_controller() != heard_[side]) {
    heard_[side] = drive.heard_controller();
    speed_heard_mps_ = robot.rim_speed();
  }
  if (drive.state_name() == state_[side]) return;
  state_[side] = drive.state_name();
  event(now, std::string(side == 0 ? "left " : "right ") + state_[side]);
}

void PlantLog::follow_motion(SimulatedRobot& robot, Time now) {
  const Vec2 place = robot.truth().map_from_robot.position();
  if (has_place_) way_m_ += distance(place_, place);
  place_ = place;
  has_place_ = true;
  const double speed = robot.rim_speed();
  if (!moving_ && speed > kMoves_mps) {
    moving_ = true;
    event(now, "moving");
  }
  if (moving_ && speed == 0.0) {
    moving_ = false;
    const double silent_ms = 1e3 * to_seconds(now - std::max(heard_[0], heard_[1]));
    event(now,
          text("at rest, %.0f ms after the controller was last heard, from %.3f m/s", silent_ms, speed_heard_mps_));
  }
}

void PlantLog::finish(SimulatedRobot& robot, Time now) {
  const sim::Truth& truth = robot.truth();
  const CanHealth bus = robot.bus_health();
  event(now,
        text("ends at %.3f %.3f %.3f", truth.map_from_robot.x, truth.map_from_robot.y, truth.map_from_robot.heading));
  event(now, text("drove %.2f m", way_m_));
  event(now, text("contacts %u caused %u forced %u", truth.contacts, truth.contacts_caused, truth.forced_movers));
  event(now, text("frames lost %llu malformed %llu", static_cast<unsigned long long>(bus.frames_lost),
                  static_cast<unsigned long long>(bus.malformed)));
  event(now, "drives " + std::string(robot.drive(0).state_name()) + " " + std::string(robot.drive(1).state_name()));
}

}  // namespace jaywalk::rig
