#include "planner/tracking/prediction.h"

#include <algorithm>

#include "planner/tracking/kalman.h"

namespace jaywalk {
namespace {

constexpr double kGivenAccelStd = 0.5;  // m/s2: the paper's movers keep their speed and seldom turn

}  // namespace

double step_seconds(Time from, Time to) noexcept {
  if (from == kNever || to <= from) return 0.0;
  return std::min(to_seconds(to - from), kForeseenS);
}

void predict_to(Body& body, Time stamp) noexcept {
  const double dt = step_seconds(body.track.stamp, stamp);
  if (body.given) {
    predict(body.track, dt, kGivenAccelStd);
  } else {
    body.models.predict(body.track, dt);
  }
  // A clock set back by less than a second goes on from there: filters that waited for it would take what they see as
  // seen at once.
  body.track.stamp = body.given ? std::max(body.track.stamp, stamp) : stamp;
}

}  // namespace jaywalk
