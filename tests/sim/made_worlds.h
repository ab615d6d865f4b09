#pragma once
// Small worlds whose numbers can be worked by hand.
#include <functional>
#include <string>
#include <vector>

#include "hal/sim/simulation.h"
#include "hal/sim/walls.h"
#include "tests/recording/scratch.h"
#include "tests/support/catch.h"
#include "tests/support/text.h"

namespace jaywalk::sim {

/// Walls of a 10 m x 10 m room, lower left corner at the origin, as MobileSim writes them (mm).
inline const std::string kRoom =
    "2D-Map\nNumLines: 4\nLINES\n0 0 10000 0\n10000 0 10000 10000\n10000 10000 0 10000\n0 10000 0 0\nDATA\n";

/// A scenario's map and robot, lines 1 to 5.
inline const std::string kMap = "[map]\naria = \"room.map\"\n";
inline const std::string kRobot = "[robot]\nstart = [5, 5, 0]\ngoal = [8, 8]\n";

/// A robot's own file, lines 1 to 15, but for its scanners, and one scanner.
inline const std::string kBody =
    "[footprint]\nfront_m = 0.3\nrear_m = 0.2\nhalf_width_m = 0.25\n"
    "[drive]\nwheel_radius_m = 0.1\ntrack_width_m = 0.4\nmax_wheel_speed_radps = 10\n"
    "[limits]\nmax_speed_mps = 0.8\nmax_turn_radps = 1.2\nmax_accel_mps2 = 0.4\nmax_turn_accel_radps2 = 2\n"
    "max_jerk_mps3 = 1.5\nbrake_mps2 = 0.9\n";
inline const std::string kScanner =
    "mount = [0.1, 0.0, 3.0]\nfov_deg = 180\nbeams = 181\nrate_hz = 10\nrange_min_m = 0.1\nrange_m = 8\n";

/// The program's own folder, with the room and a recorded walk in it.
inline const Scratch& folder() {
  static const Scratch scratch;
  scratch.write("room.map", kRoom);
  scratch.write("walk.csv", "t_s,id,x_m,y_m\n0,1,1,1\n1,1,2,1\n");
  return scratch;
}

/// The room's walls, and more (mm, a line each).
inline Walls room(const std::string& more = "") {
  std::string text = kRoom;
  text.insert(text.find("DATA"), more);
  return Walls(load_aria_map(folder().write("walls.map", text)));
}

/// A P3-DX in the middle of the room, looking along x; nothing moves, nothing goes wrong.
inline Scenario in_room() {
  Scenario scenario;
  scenario.name = "room";
  scenario.map_kind = MapKind::kAria;
  scenario.map_file = folder().path("room.map");
  scenario.start = {5.0, 5.0, 0.0};
  scenario.goal = {8.0, 8.0};
  scenario.model = p3dx();
  return scenario;
}

inline Scenario parsed(const std::string& text) { return load_scenario(folder().write("s.toml", text)); }

inline std::string refused(const std::string& text) {
  return refusal_of([&text] { return parsed(text); });
}

/// A text, and what its refusal must hold.
struct Bad {
  std::string text, place;
};

/// Each is refused with its cause and a remedy; `refuse` gives a text's refusal.
template <class Refuse>
void check_refused(const std::vector<Bad>& cases, const Refuse& refuse) {
  for (const Bad& bad : cases) {
    const std::string message = refuse(bad.text);
    INFO(bad.text << "\n-> " << message);
    CHECK(holds(message, bad.place));
    CHECK(holds(message, "; "));
  }
}

/// Drives at 50 Hz with fixed wheel speeds from the present time on.
inline void drive(Simulation& sim, double left, double right, double seconds, const std::function<void()>& look = {}) {
  const Hal hal = sim.hal();
  const Time end = hal.clock.now() + duration_from_seconds(seconds);
  while (hal.clock.now() < end) {
    hal.drive.command({hal.clock.now(), left, right});
    hal.clock.sleep_until(hal.clock.now() + duration_from_seconds(0.02));
    if (look) look();
  }
}

}  // namespace jaywalk::sim
