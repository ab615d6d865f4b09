#pragma once
#include <cstdint>

namespace jaywalk::baseline {

/// Who decides on motion.
enum class Baseline : std::uint8_t {
  kOurs,    ///< nobody here: motion::MotionPlanner
  kNone,    ///< the shortest path past walls; movers are not looked at
  kReplan,  ///< the shortest path past walls and past where everybody is at present, planned anew with each scan
  kDwa,     ///< dynamic window
  kOrca     ///< optimal reciprocal collision avoidance for a differential drive
};

}  // namespace jaywalk::baseline
