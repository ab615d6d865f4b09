#pragma once
// Small worlds whose numbers can be worked by hand.
#include <functional>
#include <string>

#include "hal/sim/scenario.h"
#include "hal/types/errors.h"
#include "tests/recording/scratch.h"

namespace jaywalk::sim {

/// Walls of a 10 m x 10 m room, lower left corner at the origin, as MobileSim writes them (mm).
inline const std::string kRoom =
    "2D-Map\nNumLines: 4\nLINES\n0 0 10000 0\n10000 0 10000 10000\n10000 10000 0 10000\n0 10000 0 0\nDATA\n";

/// A P3-DX in the middle of the room, looking along x; nothing moves, nothing goes wrong.
inline Scenario in_room(const Scratch& scratch, const std::string& map = kRoom) {
  Scenario scenario;
  scenario.name = "room";
  scenario.map_kind = MapKind::kAria;
  scenario.map_file = scratch.write("room.map", map);
  scenario.start = {5.0, 5.0, 0.0};
  scenario.goal = {8.0, 8.0};
  scenario.model = p3dx();
  return scenario;
}

/// What a refused start says; empty when nothing is refused.
inline std::string refusal(const std::function<void()>& start) {
  try {
    start();
  } catch (const StartupError& e) {
    return e.what();
  }
  return "";
}

inline bool says(const std::string& message, const std::string& part) {
  return message.find(part) != std::string::npos;
}

}  // namespace jaywalk::sim
