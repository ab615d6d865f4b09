#include "planner/localization/pose_doubt.h"

namespace jaywalk {
namespace {

// What the matcher's window holds (correlative_search.cc: 0.4 m and 0.42 rad to each side), as standard deviations: a
// third of a second.
constexpr double kMostPositionVar = 0.3 * 0.3, kMostHeadingVar = 0.3 * 0.3;

}  // namespace

void PoseDoubt::coasted(const Coasting::Step& step) noexcept {
  position_var_ += step.metres_std * step.metres_std;
  heading_var_ += step.radians_std * step.radians_std;
  doubtful_ = doubtful_ || position_var_ > kMostPositionVar || heading_var_ > kMostHeadingVar;
}

}  // namespace jaywalk
