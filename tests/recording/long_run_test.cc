// The memory of a report has bounds, however long the run.
#include <memory>

#include "apps/report/run_report.h"
#include "tests/support/catch.h"

namespace jaywalk {

TEST_CASE("after more values than are kept quantiles are too great by 1.6 % at most, and the greatest is exact") {
  // 0.01, 0.02 .. 1000: of 100,000 values the median is 500, the 99 % quantile 990.
  Distribution d;
  for (int k = 100'000; k > 0; --k) d.add(0.01 * k);
  CHECK(d.max() == 1000.0);
  for (const auto& [share, exact] : {std::pair{0.5, 500.0}, {0.99, 990.0}, {0.001, 1.0}}) {
    CHECK(d.quantile(share) >= exact * (1.0 - 1e-12));
    CHECK(d.quantile(share) <= exact * (1.0 + 1.0 / 64));
  }
}

TEST_CASE("a histogram's bins lie between powers of two, 64 a doubling") {
  // 1.0 begins a bin that ends at 1 + 1/64; 3 is the middle of [2, 4), whose bins are 1/32 wide.
  LogHistogram h;
  for (const double value : {1.0, 3.0, 100.0}) h.add(value);
  CHECK(h.quantile(0.3) == 1.0 + 1.0 / 64);
  CHECK(h.quantile(0.6) == 3.0 + 1.0 / 32);
  CHECK(h.quantile(1.0) == 100.0);
  h.add(0.0);
  h.add(-3.0);
  h.add(1e30);
  CHECK(h.quantile(0.1) == 0.0);
  CHECK(h.max() == 1e30);
  CHECK(h.count() == 6);
  using Doublings = std::vector<std::pair<double, std::uint64_t>>;
  CHECK(h.doublings() == Doublings{{0.0, 2}, {2.0, 1}, {4.0, 1}, {128.0, 1}, {1048576.0, 1}});
}

// Three days at five ticks a second: as many kept poses as ticks would make at the first spacing.
TEST_CASE("a report of three days keeps no more than one of an hour, from the first to the last") {
  RunReport report("");
  const auto record = std::make_unique<TickRecord>();
  std::array<Track, 2> tracks;
  std::array<TrueMover, 1> movers;
  TrueState truth;
  truth.movers = movers;
  constexpr int kTicks = 3 * 86'400 * 5;
  for (int n = 0; n < kTicks; ++n) {
    record->now = Time{std::chrono::milliseconds(200) * n};
    record->pose.map_from_robot.x = 0.001 * n;
    tracks[0].id = 7;                                          // stands there all the time
    tracks[1].id = 1000 + static_cast<std::uint32_t>(n / 50);  // another every ten seconds
    for (Track& track : tracks) track.stamp = track.last_seen = record->now;
    truth.map_from_robot.x = 0.001 * n;
    report.add({.record = *record, .tracks = tracks, .truth = &truth});
  }
  CHECK(report.driven().size() <= DrivenWay::kMostPoses);
  CHECK(report.driven().size() > DrivenWay::kMostPoses / 3);
  CHECK(report.driven().front().t == Time{});
  CHECK(to_seconds(Time{std::chrono::milliseconds(200) * kTicks} - report.driven().back().t) < 60.0);
  for (const std::vector<Trail>& book : {report.track_trails(), report.mover_trails()}) {
    CHECK(book.size() <= TrailBook::kMostTrails);
    std::size_t points = 0;
    for (const Trail& trail : book) points += trail.points.size();
    CHECK(points <= TrailBook::kMostPoints);
  }
  CHECK(report.track_trails().front().id == 7);
  CHECK(report.track_trails().back().id == 1000 + (kTicks - 1) / 50);
  CHECK(report.path_length_m() == Approx(0.001 * (kTicks - 1)).epsilon(1e-6));
}

}  // namespace jaywalk
