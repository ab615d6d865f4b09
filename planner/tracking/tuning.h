#pragma once
// Constants of the tracker that more than one rule reads. Those of one rule stand beside it, with their source.
#include "hal/types/time.h"

namespace jaywalk {
/// Beams that all pass over so much of a target's place pass through it, m, and for so long, s: it is gone.
inline constexpr double kEmptyWithinM = 0.1, kLookedThroughForS = 0.3;
/// Gain of running means over detections, a scan: the last three make half of one.
inline constexpr double kMeanGain = 0.2;
/// A target known for less is dropped when it is not seen for as long, s: dark cloth returns nothing for half a second,
/// and its speed is not worth going by.
inline constexpr double kTentativeS = 0.6;
/// Unseen for longer, s, a target may be another; and one that stood for as long has walked only since.
inline constexpr double kPauseS = 0.4;
/// Speeds between standing and walking, m/s. No data on their choice is kept, and none was varied.
inline constexpr double kStoppedMps = 0.10;  ///< a moving track that is slower stands, for now
inline constexpr double kStartsMps = 0.07;   ///< a pedestrian drawn for prediction that is no faster stands
inline constexpr double kWalksMps = 0.2;     ///< a usual walking speed: slower tracks teach prediction nothing
/// A track and a standing pedestrian this near are one, m.
inline constexpr double kSamePedestrianM = 0.4;
/// A target that has not gone farther than half a step stands, m: more than a pedestrian sways.
inline constexpr double kStandsWithinM = 0.25;
/// A pedestrian that turns on the spot has walked on by then; 5 s are what an obstacle may take to enter the map.
inline constexpr Duration kMayGoOnWithin = duration_from_seconds(3.0);
/// A target that is not seen is predicted for so long, s: then it may have turned or stopped.
inline constexpr double kForeseenS = 1.0;
/// Points this near a target's outline are its own, m.
inline constexpr double kSkinM = 0.15;

}  // namespace jaywalk
