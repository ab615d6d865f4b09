// From starts at random beside walls that lie partly out of the laser's sight: nothing is touched, and it leaves.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>

#include "hal/sim/random.h"
#include "tests/firmware/simulated_drive.h"
#include "tests/recording/scratch.h"
#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

constexpr double kLimit_s = 60.0;
constexpr double kLeft_m = 1.0;  // from where it began

enum class Beside { kLongWall, kEndOfWall, kCornerBehind, kCornerAhead };
constexpr std::array kNames{"long wall", "end of wall", "corner behind", "corner ahead"};

/// A wall along y = 0, the robot above it at a gap.
struct Start {
  Beside kind = Beside::kLongWall;
  RobotModel model;
  double gap_m = 0.0;
  Pose2 pose;
  Vec2 goal;
  std::string walls;
};

std::string line(Vec2 from, Vec2 to) {
  const auto mm = [](double metres) { return std::to_string(std::lround(1000.0 * metres)) + " "; };
  return mm(from.x) + mm(from.y) + mm(to.x) + mm(to.y) + "\n";
}

/// How far the outline reaches from the axle along a direction.
double reach(const Footprint& body, double heading, Vec2 along) {
  double most = 0.0;
  for (const double x : {body.front_m, -body.rear_m}) {
    for (const double y : {body.half_width_m, -body.half_width_m})
      most = std::max(most, dot(direction(heading), along) * x + cross(direction(heading), along) * y);
  }
  return most;
}

/// Walls beside the start: the long one, with an end near the body or a corner before or behind it.
std::string walls_beside(Start& start, sim::Random& random) {
  const bool looks_left = std::fabs(start.pose.heading) > 0.5 * kPi;
  const double ahead = (start.kind == Beside::kCornerAhead) != looks_left ? 1.0 : -1.0;
  if (start.kind == Beside::kLongWall) return line({-6.0, 0.0}, {6.0, 0.0});
  if (start.kind == Beside::kEndOfWall) {
    const double end = random.uniform(-0.6, 1.0), sign = random.uniform() < 0.5 ? 1.0 : -1.0;
    return line({sign * end, 0.0}, {sign * (end - 3.0), 0.0});
  }
  const double off = reach(start.model.footprint, start.pose.heading, {ahead, 0.0}) + random.uniform(0.03, 0.3);
  return line({-6.0, 0.0}, {6.0, 0.0}) + line({ahead * off, 0.0}, {ahead * off, 2.0});
}

Start drawn(const RobotModel& model, std::uint64_t seed) {
  sim::Random random(seed, sim::Purpose::kPlacement, 58);
  Start start;
  start.model = model;
  const double kind = random.uniform();
  start.kind = kind < 0.5    ? Beside::kLongWall
               : kind < 0.7  ? Beside::kEndOfWall
               : kind < 0.85 ? Beside::kCornerBehind
                             : Beside::kCornerAhead;
  const double fov_deg = random.uniform(180.0, 360.0);
  start.model.laser.fov_rad = fov_deg * kPi / 180.0;
  start.model.laser.beams = static_cast<std::uint32_t>(3.0 * fov_deg) + 1;
  start.gap_m = random.uniform(0.03, 0.30);
  const double tilt = random.uniform() < 0.5 ? 0.0 : random.uniform(-0.2, 0.2);
  start.pose.heading = wrap_angle(tilt + (random.uniform() < 0.5 ? 0.0 : kPi));
  start.pose.y = start.gap_m + reach(model.footprint, start.pose.heading, {0.0, -1.0});
  start.walls = walls_beside(start, random);
  const double aside = random.uniform(0.15, 0.85) * kPi;
  start.goal = start.pose.position() + direction(aside) * random.uniform(2.5, 4.5);
  start.goal.y = std::max(start.goal.y, 1.0);
  return start;
}

std::string map_of(const Start& start) {
  const std::string room = line({-6.0, -3.0}, {6.0, -3.0}) + line({6.0, -3.0}, {6.0, 6.0}) +
                           line({6.0, 6.0}, {-6.0, 6.0}) + line({-6.0, 6.0}, {-6.0, -3.0});
  const std::string lines = room + start.walls;
  return "2D-Map\nNumLines: " + std::to_string(std::count(lines.begin(), lines.end(), '\n')) + "\nLINES\n" + lines +
         "DATA\n";
}

struct Drive {
  bool caused = false, touched = false, left = false;
  double seconds = 0.0;
};

Drive driven(const Start& start, std::uint64_t seed) {
  const Scratch scratch;
  const std::string map = scratch.write("walls.map", map_of(start));
  SimulatedDrive drive("crossing", seed, [&](sim::Scenario& s) {
    s.map_kind = sim::MapKind::kAria;
    s.map_file = map;
    s.wanderers.clear();
    s.model = start.model;
    s.start = start.pose;
    s.goal = start.goal;
  });
  Drive result;
  (void)drive.arrives(kLimit_s, [&](const TickRecord& t) {
    result.seconds = to_seconds(t.now);
    result.left = result.left || distance(drive.truth().map_from_robot.position(), start.pose.position()) > kLeft_m;
  });
  result.touched = drive.truth().contacts > 0;
  result.caused = drive.truth().contacts_caused > 0;
  return result;
}

void check_leaves(const RobotModel& model, int trials) {
  int left = 0;
  for (int k = 0; k < trials; ++k) {
    const auto seed = static_cast<std::uint64_t>(k + 1) + (model.footprint.front_m > 0.5 ? 5000 : 1000);
    const Start start = drawn(model, seed);
    const Drive drive = driven(start, seed);
    CAPTURE(seed, model.name, kNames.at(static_cast<std::size_t>(start.kind)), start.gap_m, start.pose.heading);
    CAPTURE(start.model.laser.fov_rad, start.goal.x, start.goal.y, drive.seconds);
    CHECK_FALSE(drive.caused);
    left += drive.left && !drive.touched ? 1 : 0;
  }
  std::printf("%s: %d trials, %d left\n", model.name.c_str(), trials, left);
  CHECK(left >= 0.95 * trials);
}

}  // namespace

TEST_CASE("from six random starts beside walls a robot leaves and touches nothing") {
  check_leaves(GENERATE(p3dx(), wheelchair()), 6);
}
TEST_CASE("from a hundred random starts beside walls a P3-DX leaves and touches nothing", "[long]") {
  check_leaves(p3dx(), 100);
}
TEST_CASE("from a hundred random starts beside walls a wheelchair leaves and touches nothing", "[long]") {
  check_leaves(wheelchair(), 100);
}
