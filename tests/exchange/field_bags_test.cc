// Recordings as public bug reports have them: read, and what is left out is told.
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "tests/exchange/made_bags.h"
#include "tests/recording/scratch.h"
#include "tests/support/catch.h"
#include "tests/support/text.h"

namespace jaywalk::exchange {
namespace {

using namespace tests;

constexpr std::int64_t kSecond = 1'000'000'000, kBegin = 1'600'000'000 * kSecond;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Sixty scans and poses, ten a second.
std::vector<MadeMessage> long_drive() {
  std::vector<MadeMessage> drive{made_drive(false).front()};
  for (int k = 0; k < 60; ++k) {
    const std::int64_t ns = kBegin + k * kSecond / 10;
    drive.push_back({"/scan", "sensor_msgs/LaserScan", ns, scan_bytes(false, ns, "laser", {1.0F, 2.0F, 3.0F})});
    drive.push_back({"/odom", "nav_msgs/Odometry", ns, odometry_bytes(false, ns, 0.01 * k)});
  }
  return drive;
}

/// The messages of part `part` of several, `count` each behind the frames, which are in the first.
std::vector<MadeMessage> part_of(const std::vector<MadeMessage>& drive, std::size_t part, std::size_t count) {
  const auto at = [&](std::size_t number) { return drive.begin() + static_cast<std::ptrdiff_t>(number); };
  return {at(part == 0 ? 0 : 1 + part * count), at(1 + (part + 1) * count)};
}

TEST_CASE("the parts of a bag without a list of them come in the order of their times, b_2 before b_10") {
  const std::vector<MadeMessage> drive = long_drive();
  for (const bool renamed : {false, true}) {
    const Scratch scratch;
    for (std::size_t part = 0; part < 12; ++part) {
      const std::string name = "b_" + std::to_string(renamed ? 11 - part : part) + ".mcap";
      scratch.write(name, mcap_of(part_of(drive, part, 10), ""));
    }
    if (renamed) scratch.write("metadata.yaml", "");  // what loss of power leaves
    const sim::RecordedLog log = load_bag(scratch.folder(), {});
    CHECK(log.scans.size() == 60);
    CHECK(log.odometry.size() == 60);
    CHECK(log.refused.empty());
  }
}

TEST_CASE("a damaged part of several is left out and told, and so is the gap that it leaves") {
  const Scratch scratch;
  const std::vector<MadeMessage> drive = long_drive();
  for (std::size_t part = 0; part < 4; ++part) {
    const std::string bytes = mcap_of(part_of(drive, part, 30), "");
    scratch.write("b_" + std::to_string(part) + ".mcap", part == 2 ? bytes.substr(0, bytes.size() / 2) : bytes);
  }
  const sim::RecordedLog log = load_bag(scratch.folder(), {});
  CHECK(log.scans.size() == 45);
  CHECK(holds(log.complaint(), "left out: "));
  CHECK(holds(log.complaint(), "b_2.mcap: byte "));
  CHECK(holds(log.complaint(), "no scans for 1.6 s from 2.9 s on"));
}

TEST_CASE("Foxglove's LaserScan in protobuf is read, and its frames tell the mount") {
  const sim::RecordedLog log = read_as_mcap(made_foxglove_drive());
  REQUIRE(log.scans.size() == 10);
  CHECK(log.scans[3].beams == 4);
  CHECK(log.scans[3].angle_step_rad == 1.0F);
  CHECK(log.scans[3].range_max_m == 7.5F);
  CHECK(log.scans[3].stamp == Time{Duration{kBegin + 3 * kSecond / 10}});
  CHECK(log.range_m[2] == 7.5F);
  CHECK(log.odometry.size() == 10);
  CHECK(log.robot_from_laser == Pose2{0.2, 0.1, 0.0});
  const std::vector<MadeMessage> other{{"/a", "other.Scan", 1, "x"}};
  CHECK(holds(refusal_of([&] { return read_as_mcap(other); }), "there are: /a (other.Scan)"));
}

TEST_CASE("ROS 1 bags are read by their chunks, whatever their index claims and whatever lies before it") {
  const Scratch scratch;
  for (const std::string& behind :
       {ros1_index(10, 120), ros1_index(10, 200), ros1_index(1, 20) + ros1_index(30, 600), std::string(777, '\xEE'),
        ros1_index(3, 60) + std::string("\1\0\0\0 junk that begins like a record", 35)}) {
    for (const std::string method : {"", "bz2"}) {
      const sim::RecordedLog log = load_bag(scratch.write("a.bag", ros1_bag_of(made_drive(true), method, behind)), {});
      CHECK(log.scans.size() == 10);
      CHECK(log.odometry.size() == 10);
      CHECK(log.refused.empty());
    }
  }
}

TEST_CASE("a ROS bag of an older format is named, and what reads it") {
  const Scratch scratch;
  for (const std::string first : {"#ROSRECORD V1.2", "#ROSLOG V1.1", "#ROSBAG V1.2"}) {
    const std::string file = scratch.write("a.bag", first + "\n" + std::string(200, ' '));
    CHECK(holds(refusal_of([&] { return load_bag(file, {}); }),
                "'" + first + "', no ROS 1 bag of format 2.0; write it anew with Python's rosbag"));
  }
}

TEST_CASE("an odd message is left out, counted and told with its place, be it the first or amid") {
  const auto scan = [](const MadeFan& fan, std::vector<float> ranges = {1.0F, 2.0F, 3.0F}) {
    return [=](std::int64_t ns) { return scan_bytes(false, ns, "laser", ranges, fan); };
  };
  const auto odometry = [](double x, double v, double w) {
    return [=](std::int64_t ns) { return odometry_bytes(false, ns, x, v, "base_link", w); };
  };
  struct Odd {
    std::string topic, cause;
    std::function<std::string(std::int64_t)> bytes;
  };
  const std::vector<Odd> all{
      {"/scan", "range limits that hold nothing", scan({.range_max_m = 0.0F})},
      {"/scan", "range limits that hold nothing", scan({.range_min_m = -0.01F})},
      {"/scan", "beam angles that make no fan", scan({.step_rad = 0.0F})},
      {"/scan", "beam angles that make no fan", scan({.step_rad = std::nanf("")})},
      {"/scan", "it is empty", scan({}, {})},
      {"/odom", "a pose that is none", odometry(kNaN, 1.0, 1.0)},
      {"/odom", "a pose that is none", odometry(1e256, 1.0, 1.0)},
      {"/odom", "a pose that is none", odometry(0.0, 1.0, kNaN)},
      {"/odom", "a speed that is none", odometry(0.0, kNaN, 1.0)},
      {"/scan", "its time is over an hour from the others'",
       [&](std::int64_t ns) { return scan({})(ns + 4000 * kSecond); }},
      {"/scan", "its time is over an hour from the others'", [&](std::int64_t /*ns*/) { return scan({})(7); }},
      {"/odom", "its time is over an hour from the others'",
       [&](std::int64_t /*ns*/) { return odometry(0.0, 1.0, 1.0)(7); }},
      {"/scan", "its bytes are no sensor_msgs/LaserScan", [](std::int64_t /*ns*/) { return std::string("junk"); }}};
  for (const Odd& odd : all) {
    for (const int place : {1, 4, 10}) {
      std::vector<MadeMessage> drive = made_drive(false);
      int number = 0;
      for (MadeMessage& message : drive)
        if (message.topic == odd.topic && ++number == place) message.bytes = odd.bytes(message.ns);
      const sim::RecordedLog log = read_as_mcap(drive);
      CHECK(log.scans.size() == (odd.topic == "/scan" ? 9 : 10));
      CHECK(log.odometry.size() == (odd.topic == "/odom" ? 9 : 10));
      CHECK(holds(log.complaint(), odd.topic + ": 1 message left out, the first is message " + std::to_string(place) +
                                       ": " + odd.cause));
    }
  }
}

TEST_CASE("a clock that is set right on the way costs the messages of the wrong time alone") {
  std::vector<MadeMessage> drive{made_drive(false).front()};
  for (int k = 0; k < 40; ++k) {
    const bool ahead = k >= 20 && k < 26;
    const std::int64_t ns = kBegin + k * kSecond / 10 + (ahead ? 600 * kSecond : 0);
    drive.push_back({"/scan", "sensor_msgs/LaserScan", ns, scan_bytes(false, ns, "laser", {1.0F, 2.0F, 3.0F})});
  }
  const sim::RecordedLog log = read_as_mcap(drive);
  CHECK(log.scans.size() == 34);
  CHECK(holds(log.complaint(), "6 messages left out, the first is message 21: its time is ahead of those after it"));
}

TEST_CASE("a log without a good message is refused with the first one's place and cause") {
  std::vector<MadeMessage> scans = made_drive(false), odometry = scans;
  rewrite(scans, "/scan", [](std::int64_t ns, int) { return scan_bytes(false, ns, "laser", {}); });
  CHECK(holds(refusal_of([&] { return read_as_mcap(scans); }), "/scan: message 1: no scan in it: it is empty"));
  rewrite(odometry, "/odom", [](std::int64_t ns, int) { return odometry_bytes(false, ns, kNaN); });
  CHECK(holds(refusal_of([&] { return read_as_mcap(odometry); }),
              "/odom: message 1: no odometry in it: a pose that is none"));
}

TEST_CASE("odometry whose every speed is none counts by its poses") {
  std::vector<MadeMessage> drive = made_drive(false);
  rewrite(drive, "/odom", [](std::int64_t ns, int) { return odometry_bytes(false, ns, 0.0, kNaN); });
  const sim::RecordedLog log = read_as_mcap(drive);
  REQUIRE(log.odometry.size() == 10);
  CHECK_FALSE(log.odometry[3].twist);
}

TEST_CASE("a time_increment that makes a sweep longer than from scan to scan is told and not believed") {
  std::vector<MadeMessage> drive = made_drive(false);
  const auto with = [&](float beam_step_s) {
    rewrite(drive, "/scan", [&](std::int64_t ns, int) {
      return scan_bytes(false, ns, "laser", {1.0F, 2.0F, 3.0F}, {.beam_step_s = beam_step_s});
    });
    return read_as_mcap(drive);
  };
  // Half a turn at ten a second: 0.05 s where the laser spins.
  const sim::RecordedLog log = with(0.375F);
  CHECK(to_seconds(log.sweep) == Approx(0.05));
  CHECK(holds(log.complaint(),
              "time_increment says sweeps of 0.750 s, scans come every 0.100 s: taken to sweep in 0.050 s"));
  CHECK(to_seconds(with(0.04F).sweep) == Approx(0.08));
}

TEST_CASE("where the odometry's child joins nothing, base_link is tried") {
  std::vector<MadeMessage> drive = made_drive(false);
  rewrite(drive, "/odom", [](std::int64_t ns, int) { return odometry_bytes(false, ns, 0.0, 1.0, "robot_base"); });
  const sim::RecordedLog log = read_as_mcap(drive);
  CHECK(log.robot_from_laser == Pose2{0.2, 0.0, 0.0});
  CHECK(holds(log.complaint(), "from base_link to laser"));
}

TEST_CASE("scans whose number of beams changes are read alike") {
  std::vector<MadeMessage> drive = made_drive(false);
  rewrite(drive, "/scan", [](std::int64_t ns, int k) {
    const std::size_t beams = k == 2 ? 200 : 447 + static_cast<std::size_t>(k) % 5;
    const float step = 6.28318531F / static_cast<float>(beams);
    return scan_bytes(false, ns, "laser", std::vector<float>(beams, 3.0F), {.step_rad = step});
  });
  const sim::RecordedLog log = read_as_mcap(drive);
  REQUIRE(log.scans.size() == 10);
  for (const sim::RecordedScan& scan : log.scans) CHECK(scan.beams == log.scans.back().beams);
  CHECK(std::count(log.range_m.begin(), log.range_m.end(), 3.0F) == static_cast<std::ptrdiff_t>(log.range_m.size()));
}

}  // namespace
}  // namespace jaywalk::exchange
