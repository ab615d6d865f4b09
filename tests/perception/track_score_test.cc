#include "bench/tracking/track_score.h"

#include <cmath>
#include <limits>

#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::bench;

namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

Target target(std::uint32_t id, double x, bool in_view = true) { return {id, {x, 0.0}, {kUnknown, kUnknown}, in_view}; }
Hypothesis track(std::uint32_t id, double x, bool moving = true) { return {id, {x, 0.0}, {}, moving}; }

const Target kStands{1, {}, {}, true}, kWalks{1, {}, {0.4, 0.0}, true};

struct Scored {
  TrackScore score{ScoreRules{}};
  void frame(double t_s, std::vector<Target> targets, std::vector<Hypothesis> tracks) {
    score.add(t_s, targets, tracks);
  }
};

/// A score after frames in which the target was not found, and one at `found_s` in which it was.
TrackScore found_after(std::initializer_list<std::pair<double, Target>> unfound, double found_s) {
  Scored s;
  for (const auto& [t_s, target] : unfound) s.frame(t_s, {target}, {});
  s.frame(found_s, {kWalks}, {track(7, 0.0)});
  return s.score;
}

/// `metres` along +x in steps of 0.1 m; the estimate is `scale` times as far, in a frame of its own.
std::vector<PosePair> straight(int metres, double scale, double turn_rad_per_m) {
  std::vector<PosePair> drive;
  const Pose2 elsewhere{3.0, -2.0, 1.0};
  for (int k = 0; k <= 10 * metres; ++k) {
    const double x = 0.1 * k;
    drive.push_back({elsewhere * Pose2{scale * x, 0.0, turn_rad_per_m * x}, {x, 0.0, 0.0}});
  }
  return drive;
}

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

TEST_CASE("of four targets one missed and one false positive leave half") {
  Scored s;
  s.frame(0.0, {target(1, 0.0), target(2, 5.0)}, {track(7, 0.1), track(8, 5.3)});
  s.frame(0.1, {target(1, 0.0), target(2, 5.0)}, {track(7, 0.2), track(9, 8.0)});
  CHECK(s.score.targets() == 4);
  CHECK(s.score.misses() == 1);
  CHECK(s.score.false_positives() == 1);
  CHECK(s.score.switches() == 0);
  CHECK(s.score.mota() == Approx(0.5));                      // 1 - (1 + 1 + 0) / 4
  CHECK(s.score.motp_m() == Approx((0.1 + 0.3 + 0.2) / 3));  // matches only
  CHECK(s.score.false_movers() == 1);                        // 9; 8 was somebody's once
}

TEST_CASE("a pair stays a pair though another track comes nearer and a new name is one switch") {
  Scored s;
  s.frame(0.0, {target(1, 0.0)}, {track(7, 0.1)});
  s.frame(0.1, {target(1, 0.0)}, {track(7, 0.4), track(8, 0.0)});
  CHECK(s.score.switches() == 0);
  CHECK(s.score.false_positives() == 1);
  s.frame(0.2, {target(1, 0.0)}, {track(8, 0.0)});
  s.frame(0.3, {target(1, 0.0)}, {track(8, 0.0)});
  CHECK(s.score.switches() == 1);
}

TEST_CASE("a new name is a quick switch where the target had been found a second before or less") {
  Scored s;
  s.frame(0.0, {target(1, 0.0)}, {track(7, 0.0)});
  s.frame(1.0, {target(1, 0.0)}, {track(8, 0.0)});
  CHECK(s.score.quick_switches() == 1);
  s.frame(1.5, {target(1, 0.0)}, {});
  s.frame(2.1, {target(1, 0.0)}, {track(9, 0.0)});  // 1.1 s after it was last found
  CHECK(s.score.switches() == 2);
  CHECK(s.score.quick_switches() == 1);
}

TEST_CASE("who is out of view is neither missed nor a false positive when found") {
  Scored s;
  s.frame(0.0, {target(1, 0.0, false)}, {track(7, 0.1)});
  s.frame(0.1, {target(1, 0.0, false)}, {});
  CHECK(s.score.targets() + s.score.false_positives() + s.score.false_movers() == 0);
  CHECK(std::isnan(s.score.mota()));
}

TEST_CASE("a standing track may find a target and is no error elsewhere") {
  Scored s;
  s.frame(0.0, {target(1, 0.0)}, {track(7, 0.1, false), track(8, 9.0, false)});
  CHECK(s.score.matches() == 1);
  CHECK(s.score.false_positives() == 0);
}

TEST_CASE("velocities are compared from a second after a track's first frame") {
  Scored s;
  const auto with = [](double vx, double vy) { return Hypothesis{7, {0.0, 0.0}, {vx, vy}, true}; };
  s.frame(0.0, {kWalks}, {with(9.0, 9.0)});  // too young to count
  s.frame(1.0, {kWalks}, {with(0.7, 0.4)});  // off by (0.3, 0.4): 0.5
  s.frame(1.1, {kWalks}, {with(0.4, 0.1)});  // 0.1
  CHECK(s.score.velocity_rmse_mps() == Approx(std::sqrt((0.25 + 0.01) / 2)));
}

TEST_CASE("coming into view is told soon once a stay and again after a second away") {
  Scored s;
  s.frame(0.0, {target(1, 0.0)}, {});
  s.frame(0.5, {target(1, 0.0)}, {track(7, 0.0)});  // found after 0.5 s
  s.frame(2.0, {target(1, 0.0)}, {});               // 1.5 s away: a new stay
  s.frame(2.7, {target(1, 0.0)}, {});               // not found for 0.7 s: late
  s.frame(2.8, {target(1, 0.0)}, {track(7, 0.0)});
  CHECK(s.score.found_soon() == Approx(0.5));
}

TEST_CASE("the time to be found begins when a target first moves in view") {
  const TrackScore score = found_after({{0.0, kStands}, {0.9, kStands}, {1.0, kWalks}}, 1.5);
  CHECK(score.found_soon() == 1.0);  // after half a second
}

TEST_CASE("while a target is hidden or stands its time to be found stands still, and runs on by the clock") {
  const Target hidden{1, {}, {0.4, 0.0}, false};
  for (const Target& meanwhile : {hidden, kStands}) {
    const TrackScore score =
        found_after({{0.0, kWalks}, {0.3, kWalks}, {0.6, meanwhile}, {0.9, meanwhile}, {1.0, kWalks}}, 1.2);
    CHECK(score.found_soon() == 1.0);  // 0.5 s or 0.6 s of moving in view
    CHECK(score.found_soon_by_clock() == 0.0);
  }
  const TrackScore late = found_after({{0.0, kWalks}, {0.3, kWalks}, {0.5, hidden}, {0.9, kWalks}, {1.3, kWalks}}, 1.4);
  CHECK(late.found_soon() == 0.0);  // 0.7 s of moving in view
}

TEST_CASE("where each is to be taken as it is a standing track finds only who stands") {
  ScoreRules rules;
  rules.as_it_is = true;
  TrackScore score(rules);
  const std::vector<Target> targets{{1, {0.0, 0.0}, {0.0, 0.0}, true}, {2, {5.0, 0.0}, {0.4, 0.0}, true}};
  score.add(0.0, targets, std::vector<Hypothesis>{track(7, 0.0, false), track(8, 5.0, false)});
  CHECK(score.matches() == 1);
  score.add(0.1, targets, std::vector<Hypothesis>{track(7, 0.0, true), track(8, 5.0, true)});
  CHECK(score.matches() == 3);
  CHECK(score.false_positives() == 0);
}

TEST_CASE("a steady target's velocity is wrong beyond 0.3 m/s and its place within what is claimed up to 2.45 sigmas") {
  Scored s;
  for (int k = 0; k <= 30; ++k) {
    const double t = 0.1 * k;
    const double wrong_mps = k == 25 ? 0.31 : 0.29, off_m = k == 29 ? 0.25 : 0.24;  // 0.1 m times sqrt(5.99) is 0.245
    s.frame(t, {Target{1, {t, 0.0}, {1.0, 0.0}}}, {Hypothesis{7, {t, off_m}, {1.0 + wrong_mps, 0.0}, true, 0.1}});
  }
  CHECK(s.score.steady_wrong() == Approx(1.0 / 21));  // frames from 1.0 s on: the track is settled, the target steady
  CHECK(s.score.covered() == Approx(20.0 / 21));
}

TEST_CASE("a target that turned less than a second ago is not steady") {
  Scored s;
  for (int k = 0; k <= 30; ++k) {
    const double vx = k % 8 < 4 ? 1.0 : -1.0;
    s.frame(0.1 * k, {Target{1, {}, {vx, 0.0}}}, {Hypothesis{7, {}, {}, true, 0.1}});
  }
  CHECK(std::isnan(s.score.steady_wrong()));
  CHECK(std::isnan(s.score.covered()));
}

TEST_CASE("wheels one percent too large are one percent wrong, a drift of a milliradian a metre 0.573 degrees in ten") {
  const RelativeError error = relative_error(straight(12, 1.01, 0.0), 10.0, 1.0);
  CHECK(error.stretches == 3);  // from 0, 1 and 2 m
  CHECK(error.translation_percent == Approx(1.0).epsilon(1e-3));
  CHECK(error.heading_deg == Approx(0.0).margin(1e-9));
  CHECK(relative_error(straight(11, 1.0, 0.001), 10.0, 1.0).heading_deg == Approx(0.573).epsilon(1e-2));
}

TEST_CASE("a drive shorter than the stretch tells nothing, and standing noise is no way") {
  const RelativeError error = relative_error(straight(9, 1.0, 0.0), 10.0, 1.0);
  CHECK(error.stretches == 0);
  CHECK(std::isnan(error.translation_percent));
  std::vector<PosePair> drive(1000);
  for (std::size_t k = 0; k < drive.size(); ++k) drive[k].truth.x = k % 2 == 0 ? 0.0 : 0.04;
  CHECK(relative_error(drive, 10.0, 1.0).stretches == 0);
}

TEST_CASE("the greatest step error is that of the worst step, seen from where the true one leads") {
  // The second step turns by 0.1 rad and goes 0.3 m where the truth goes straight on for 0.5 m.
  const std::vector<PosePair> drive = {
      {{}, {}}, {{1.0, 0.0, 0.0}, {1.0, 0.0, 0.0}}, {{1.3, 0.0, 0.1}, {1.5, 0.0, 0.0}}};
  CHECK(greatest_step_error(drive).translation_m == Approx(0.2));
  CHECK(greatest_step_error(drive).heading_deg == Approx(5.7296));
}

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
