#include "drivers/ros/ros_scan.h"

#include <limits>

#include "drivers/laser/scanner_connection.h"
#include "tests/drivers/hand_clock.h"
#include "tests/drivers/random_bytes.h"
#include "tests/drivers/ring_path.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace std::chrono_literals;

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity(), kNan = std::numeric_limits<float>::quiet_NaN();

/// Five beams over 40 degrees about ahead, taken in 50 ms, which came `age` ago.
ros::ScanMessage scan_at(Time now, Duration age = 0ms) {
  ros::ScanMessage m;
  m.stamp_ns = (now - age - 50ms).time_since_epoch().count();
  m.sweep_ns = std::chrono::nanoseconds(50ms).count();
  m.period_ns = std::chrono::nanoseconds(100ms).count();
  m.beam_count = 5;
  m.first_angle_rad = -0.35F;
  m.angle_step_rad = 0.175F;
  m.range_min_m = 0.1F;
  m.range_max_m = 10.0F;
  m.range_m = {1.0F, kInfinity, kNan, -kInfinity, 12.0F};
  return m;
}

Heard decode(const ros::ScanMessage& m, LaserScan& scan, bool infinity_is_free = false) {
  return ros::decode_scan({reinterpret_cast<const std::uint8_t*>(&m), sizeof m}, Time{20s}, infinity_is_free, scan);
}

/// A scanner as run makes it, the ring's far end, and time by hand.
struct Bench {
  tests::RingPath path;
  tests::HandClock clock;
  std::unique_ptr<ScannerConnection> laser = make_scanner(
      {.kind = ScannerKind::kDds, .device = path.path().string(), .topic = "/scan", .infinity_is_free = true}, clock);
  std::unique_ptr<ros::SharedRing> far_end = ros::SharedRing::find(path, ros::kScanRing);

  void write(const ros::ScanMessage& m) { far_end->write(std::as_bytes(std::span(&m, 1))); }
  /// Ten scans a second, or none.
  void run(Duration span, bool scans) {
    for (const Time end = clock.now() + span; clock.now() < end;) {
      clock.sleep_until(clock.now() + 10ms);
      if (scans && clock.now().time_since_epoch() % 100ms == 0ms) write(scan_at(clock.now()));
      const AllocationGuard guard;
      laser->step();
      static_cast<void>(laser->latest());
      heap_calls += guard.calls();
    }
  }
  std::uint64_t heap_calls = 0;
};

}  // namespace

TEST_CASE("a ROS scan's beams prove what REP 117 says, and infinity only where the file trusts it") {
  LaserScan scan;
  REQUIRE(decode(scan_at(Time{20s}), scan, true) == Heard::kScan);
  CHECK(scan.stamp == Time{20s - 50ms});
  CHECK(scan.sweep == 50ms);
  CHECK(scan.period == 100ms);
  CHECK(scan.state(0) == BeamState::kHit);
  CHECK(scan.state(1) == BeamState::kFree);
  CHECK(scan.state(2) == BeamState::kUnknown);
  CHECK(scan.state(3) == BeamState::kUnknown);
  CHECK_FALSE(scan.too_near(3));  // minus infinity is the robot itself here, and something close there
  CHECK(scan.state(4) == BeamState::kFree);
  REQUIRE(decode(scan_at(Time{20s}), scan, false) == Heard::kScan);
  CHECK(scan.state(0) == BeamState::kHit);
  for (std::size_t beam = 1; beam < 5; ++beam) CHECK(scan.state(beam) == BeamState::kUnknown);
}

TEST_CASE("a message that no scanner sends is malformed") {
  LaserScan scan;
  const auto with = [&](auto change) {
    ros::ScanMessage m = scan_at(Time{20s});
    change(m);
    return decode(m, scan);
  };
  for (const float bad : {kNan, kInfinity, -kInfinity, 100.0F}) {
    CHECK(with([bad](auto& m) { m.first_angle_rad = bad; }) == Heard::kMalformed);
    CHECK(with([bad](auto& m) { m.angle_step_rad = bad; }) == Heard::kMalformed);
  }
  for (const float bad : {kNan, kInfinity, -1.0F, 1e30F}) {
    CHECK(with([bad](auto& m) { m.range_max_m = bad; }) == Heard::kMalformed);
    CHECK(with([bad](auto& m) { m.range_min_m = bad; }) == Heard::kMalformed);
  }
  CHECK(with([](auto& m) { m.angle_step_rad = 0.0F; }) == Heard::kMalformed);
  for (const std::uint32_t beams : {0U, 2U, 2049U, 0xFFFFFFFFU})
    CHECK(with([beams](auto& m) { m.beam_count = beams; }) == Heard::kMalformed);
  for (const std::int64_t ns : {INT64_MIN, std::int64_t{-1}, INT64_MAX}) {
    CHECK(with([ns](auto& m) { m.stamp_ns = ns; }) == Heard::kMalformed);
    CHECK(with([ns](auto& m) { m.sweep_ns = ns; }) == Heard::kMalformed);
    CHECK(with([ns](auto& m) { m.period_ns = ns; }) == Heard::kMalformed);
  }
  CHECK(with([](auto& m) { m.stamp_ns += 51'000'000; }) == Heard::kMalformed);  // of tomorrow
  CHECK(with([](auto&) {}) == Heard::kScan);
}

TEST_CASE("random and damaged bytes in place of ROS scans decode to scans that hold together, or to none") {
  tests::RandomBytes random(117);
  const ros::ScanMessage good = scan_at(Time{20s});
  const wire::Bytes bytes(reinterpret_cast<const std::uint8_t*>(&good), sizeof good);
  LaserScan scan;
  for (int k = 0; k < 20'000; ++k) {
    const auto made = k % 2 == 0 ? random.damaged(bytes.first(80)) : random.bytes(80);
    std::vector<std::uint8_t> message(bytes.begin(), bytes.end());
    std::copy(made.begin(), made.end(), message.begin());
    if (k % 7 == 0) message.resize(random.below(message.size()));
    if (ros::decode_scan(message, Time{20s}, k % 3 == 0, scan) != Heard::kScan) continue;
    REQUIRE(scan.beam_count <= kMaxBeams);
    REQUIRE(std::isfinite(scan.angle_rad(scan.beam_count - 1)));
    REQUIRE(scan.range_max_m > scan.range_min_m);
    REQUIRE(scan.stamp <= Time{20s});
    REQUIRE(scan.period > 0ms);
  }
}

TEST_CASE("a ROS scanner is silent where nothing comes, and well again with the next scan") {
  Bench bench;
  bench.run(500ms, false);
  CHECK(bench.laser->latest().sequence == 0);
  bench.run(2s, true);
  CHECK(bench.laser->health().trouble == ScannerTrouble::kNone);
  CHECK(bench.laser->latest().beam_count == 5);
  CHECK(bench.laser->name() == "/scan");
  const Time last = bench.laser->latest().stamp;
  bench.run(1100ms, false);  // the bridge is dead
  CHECK(bench.laser->latest().stamp == last);
  CHECK(bench.laser->health().trouble == ScannerTrouble::kSilent);
  bench.run(3s, true);
  CHECK(bench.laser->health().trouble == ScannerTrouble::kNone);
  CHECK(bench.heap_calls == 0);
}

TEST_CASE("scans that were held up are late, damaged ones are counted") {
  Bench bench;
  bench.run(500ms, true);
  const auto scans = bench.laser->health().scans;
  bench.write(scan_at(bench.clock.now(), 5s));
  bench.run(50ms, false);
  CHECK(bench.laser->health().late == 1);
  CHECK(bench.laser->health().malformed == 0);
  bench.write({});
  bench.run(10ms, false);
  CHECK(bench.laser->health().malformed == 1);
  CHECK(bench.laser->health().scans == scans);
}
