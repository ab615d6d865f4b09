#pragma once
#include <functional>
#include <string>

#include "tests/firmware/simulated_drive.h"

namespace jaywalk {

/// What came of a recording that was lived through again.
struct Relived {
  int ticks = 0;
  int different = 0;  ///< commands that differ from the recorded ones in any bit
};

/// Ticks a new controller through the recording `file`, which is removed afterwards.
Relived relive(const std::string& file);
/// The same with another planner than the setup's own.
Relived relive(const std::string& file, const std::function<Planner&(const ControlSetup&)>& planner_of);

/// Commands that differ in any bit when so long a drive among 16 movers is lived through again.
int different_commands(double seconds, const SimulatedDrive::Edit& edit = {}, PlanMode mode = PlanMode::kFull);

}  // namespace jaywalk
