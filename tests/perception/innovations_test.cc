#include <cmath>

#include "bench/tracking/track_score.h"
#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

Track walker() {
  Track track;
  track.id = 3;
  track.moving = true;
  track.hits = 10;
  return track;
}

void see(Track& track, double nis) {
  track.hits += 1;
  track.nis = nis;
}

}  // namespace

TEST_CASE("surprises of a track that moves are counted, averaged and held against their 95 percent bound") {
  Track track = walker();
  bench::Innovations innovations;
  innovations.add({&track, 1});
  see(track, 1.0);
  innovations.add({&track, 1});
  see(track, 7.0);  // beyond 5.99
  innovations.add({&track, 1});
  CHECK(innovations.count() == 2);
  CHECK(innovations.mean() == Approx(4.0));
  CHECK(innovations.share_within_95() == 0.5);
  CHECK(innovations.mean_bound() == Approx(1.96 * 2.0 / std::sqrt(2.0)));
}

TEST_CASE("what was not seen, stands, or is new tells no innovation") {
  Track track = walker();
  bench::Innovations innovations;
  innovations.add({&track, 1});  // new
  innovations.add({&track, 1});  // not seen
  track.moving = false;
  see(track, 1.0);
  innovations.add({&track, 1});  // stands
  CHECK(innovations.count() == 0);
  CHECK(std::isnan(innovations.mean()));
}
