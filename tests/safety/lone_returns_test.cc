// Drops and dust are no obstacle; what stands there is, at once where it is 2 cm wide or more, by any scanner.
#include <array>
#include <optional>

#include "firmware/safety/beam_filter.h"
#include "hal/sim/random.h"
#include "hal/sim/walls.h"
#include "tests/safety/scans.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

struct Kind {
  const char* name;
  double fov_deg;
  std::uint32_t beams;
  double rate_hz;
};

constexpr auto kKinds = std::to_array<Kind>({{"TiM571", 270.0, 811, 15.0},
                                             {"UST-20LX", 270.0, 1081, 40.0},
                                             {"LMS200", 180.0, 361, 37.5},
                                             {"LD19", 360.0 * 449 / 450, 450, 10.0},
                                             {"RPLIDAR A1", 359.0, 360, 7.5}});

/// A P3-DX with one scanner on its axle, in a round hall of 3 m; it drives straight on.
class Rainy {
 public:
  explicit Rainy(const Kind& kind, double speed_mps = 0.0) : kind_(kind), speed_mps_(speed_mps), filter_(model_, 0) {}

  /// The next scan as the loop would use it.
  const LaserScan& next(std::optional<sim::Disc> body, double rain = 0.005) {
    at_s_ += 1.0 / kind_.rate_hz;
    const double angle = speed_mps_ * at_s_ / model_.drive.wheel_radius_m;
    const double radps = speed_mps_ / model_.drive.wheel_radius_m;
    wheels_ = {time_from_seconds(at_s_), wheels_.sequence + 1, angle, angle, radps, radps};
    look(body, rain);
    seen_ = scan_;
    const AllocationGuard guard;
    filter_.filter(seen_, wheels_);
    heap_calls += guard.calls();
    return seen_;
  }
  [[nodiscard]] bool is_drop(std::size_t beam) const { return drops_[beam]; }
  [[nodiscard]] const LaserScan& raw() const { return scan_; }
  [[nodiscard]] const WheelState& wheels() const { return wheels_; }
  std::uint64_t heap_calls = 0;

 private:
  void look(std::optional<sim::Disc> body, double rain) {
    tests::lay_beams(scan_, {.robot_from_laser = {},
                             .fov_rad = kind_.fov_deg * kPi / 180.0,
                             .beams = kind_.beams,
                             .range_min_m = 0.05,
                             .range_max_m = 25.0});
    scan_.stamp = wheels_.stamp;
    ++scan_.sequence;
    drops_.fill(false);
    for (std::size_t k = 0; k < scan_.beam_count; ++k) {
      double range = 3.0;
      if (body)
        range = std::min(range, sim::hit_range({speed_mps_ * at_s_, 0.0}, direction(scan_.angle_rad(k)), *body));
      range += 0.005 * random_.normal();
      drops_[k] = random_.uniform() < rain;
      scan_.range_m[k] = static_cast<float>(drops_[k] ? random_.uniform(0.1, 0.3) : range);
    }
  }

  Kind kind_;
  double speed_mps_, at_s_ = 0.0;
  RobotModel model_ = p3dx();
  BeamFilter filter_;
  WheelState wheels_;
  LaserScan scan_, seen_;
  std::array<bool, kMaxBeams> drops_{};
  sim::Random random_{7, sim::Purpose::kRain};
};

int hits_on(const LaserScan& scan, const LaserScan& raw, double nearer_than_m) {
  int hits = 0;
  for (std::size_t k = 0; k < scan.beam_count; ++k)
    hits += raw.is_hit(k) && static_cast<double>(raw.range_m[k]) < nearer_than_m && scan.is_hit(k) ? 1 : 0;
  return hits;
}

}  // namespace

TEST_CASE("of 0.5 % of drops at 0.1 to 0.3 m not one scan in fifty shows any, and nothing else is struck out") {
  const Kind kind = GENERATE(from_range(kKinds));
  const double speed_mps = GENERATE(0.0, 0.6);
  CAPTURE(kind.name, speed_mps);
  Rainy rainy(kind, speed_mps);
  int with_drops = 0, lost = 0;
  for (int k = 0; k < 1000; ++k) {
    const LaserScan& scan = rainy.next({});
    bool shows_drop = false;
    for (std::size_t beam = 0; beam < scan.beam_count; ++beam) {
      shows_drop = shows_drop || (rainy.is_drop(beam) && scan.is_hit(beam));
      lost += rainy.is_drop(beam) || scan.is_hit(beam) ? 0 : 1;
    }
    with_drops += shows_drop ? 1 : 0;
  }
  CHECK(with_drops < 20);
  CHECK(lost == 0);
  CHECK(rainy.heap_calls == 0);
}

TEST_CASE("a cylinder of 70 mm and a leg of 120 mm are seen whole in the first scan, wherever they are, rain or none") {
  const Kind kind = GENERATE(from_range(kKinds));
  const double radius_m = GENERATE(0.035, 0.06);
  const double away_m = GENERATE(0.15, 0.3, 0.6, 1.0, 1.5, 2.0);
  for (double bearing = -1.5; bearing < 1.5; bearing += 0.07) {
    CAPTURE(kind.name, radius_m, away_m, bearing);
    Rainy rainy(kind);
    rainy.next({});
    const LaserScan& scan = rainy.next(sim::Disc{direction(bearing) * away_m, radius_m});
    for (std::size_t k = 0; k < scan.beam_count; ++k) {
      const bool on_body = rainy.raw().is_hit(k) && !rainy.is_drop(k) && rainy.raw().range_m[k] < 2.5F;
      REQUIRE((!on_body || scan.is_hit(k)));
    }
  }
}

TEST_CASE("a wire of 6 mm counts from the third scan that shows it, at rest and under way") {
  const double speed_mps = GENERATE(0.0, 0.6, 1.2);
  CAPTURE(speed_mps);
  Rainy rainy(kKinds[0], speed_mps);
  const sim::Disc wire{{speed_mps / 15.0 * 3.0 + 0.5, 0.1}, 0.003};
  for (const bool counts : {false, false, true, true})
    CHECK((hits_on(rainy.next(wire, 0.0), rainy.raw(), 2.5) > 0) == counts);
}

TEST_CASE("a scan as it was recorded is judged as it was") {
  Rainy rainy(kKinds[0]);
  BeamFilter again(p3dx(), 0);
  for (int k = 0; k < 20; ++k) {
    const LaserScan& marked = rainy.next({});
    LaserScan replayed = marked;
    again.filter(replayed, rainy.wheels());
    again.filter(replayed, rainy.wheels());  // the loop sees a scan for some ticks
    REQUIRE(std::equal(marked.range_m.begin(), marked.range_m.begin() + marked.beam_count, replayed.range_m.begin()));
  }
}
