#pragma once
namespace jaywalk {

/// Measures of a robot's nearness to pedestrians, so far in a run, as HuNavSim has them (Perez-Higueras and others
/// 2023). Distances are from the robot's outline to the middle of the nearest mover of any kind. Slowing and turning
/// are HuNavSim's social force of the robot on agents, along and across their way; movers of kind "social" alone have
/// it.
struct SocialMeasures {
  double intimate_s = 0.0;  ///< time nearer than 0.45 m
  double personal_s = 0.0;  ///< time at 0.45 to 1.2 m
  double slowed_m = 0.0;    ///< way that pedestrians lost to the robot's force against theirs
  double turned_rad = 0.0;  ///< turning of pedestrians by the robot's force across their way
};

}  // namespace jaywalk
