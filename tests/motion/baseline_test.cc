#include "apps/rivals/baseline.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::baseline;

namespace {

constexpr float kRadius = 0.3F;

/// A floor without walls, 16 m by 16 m about the origin; the goal on the right.
struct Floor {
  static constexpr int kSide = 160;
  std::vector<Place> surfaces = std::vector<Place>(kSide * kSide, Place{1e6F, 1e6F});
  std::vector<std::uint8_t> unseen = std::vector<std::uint8_t>(kSide * kSide, 0);
  std::vector<float> to_go = std::vector<float>(kSide * kSide);
  Place goal{6.0F, 0.0F};
  Guide guide{-8.0F, -8.0F, 0.1F, kSide, false, nullptr, nullptr, nullptr};
  motion::MotionBounds bounds{0.6F, 0.0F, 1.2F, 2.0F, 0.5F, 0.8F, 0.75F};

  Floor() {
    for (int j = 0; j < kSide; ++j) {
      for (int i = 0; i < kSide; ++i) {
        const float x = -7.95F + 0.1F * static_cast<float>(i) - goal.x,
                    y = -7.95F + 0.1F * static_cast<float>(j) - goal.y;
        to_go[static_cast<std::size_t>(j * kSide + i)] = std::sqrt(x * x + y * y) / bounds.speed;
      }
    }
    guide.surface = surfaces.data(), guide.unseen = unseen.data(), guide.to_go_s = to_go.data();
  }
  [[nodiscard]] Scene scene(const motion::RobotState& now, std::span<const Track> tracks) const {
    return {now, goal, tracks, guide, bounds, kRadius};
  }
};

Track standing_at(double x, double y) {
  Track track;
  track.position_in_map = {x, y};
  track.radius_m = 0.27;
  return track;
}

Track walking_at(double x, double y, Vec2 velocity) {
  Track track = standing_at(x, y);
  track.velocity_in_map = velocity;
  track.moving = true;
  return track;
}

struct Drive {
  float least_m = 1e9F;  ///< between the circles
  bool arrived = false;
};

/// From the origin for half a minute, deciding ten times a second.
Drive driven(motion::Command (*decide)(const Scene&) noexcept, Track track) {
  const Floor floor;
  motion::RobotState now{};
  Drive drive;
  for (int k = 0; k < 300 && !drive.arrived; ++k) {
    now = motion::moved(now, decide(floor.scene(now, {&track, 1})), floor.bounds, 0.1F);
    track.position_in_map = track.position_in_map + track.velocity_in_map * 0.1;
    const auto apart = static_cast<float>(distance(track.position_in_map, {double{now.x}, double{now.y}}));
    drive.least_m = std::min(drive.least_m, apart - kRadius - 0.27F);
    drive.arrived = distance({double{now.x}, double{now.y}}, {6.0, 0.0}) < 0.3;
  }
  return drive;
}

}  // namespace

TEST_CASE("without avoidance the robot drives at the goal, whatever stands there") {
  const Drive drive = driven(none, standing_at(3.0, 0.05));
  CHECK(drive.arrived);
  CHECK(drive.least_m < 0.0F);
}

TEST_CASE("planning anew, dynamic window and ORCA go round a mover that stands, ORCA round one that crosses") {
  const Track stands = standing_at(3.0, 0.05), crosses = walking_at(3.0, -2.0, {0.0, 0.4});
  for (const auto& [decide, track] : {std::pair{&replan, stands}, {&dwa, stands}, {&orca, stands}, {&orca, crosses}}) {
    const Drive drive = driven(decide, track);
    CHECK(drive.arrived);
    CHECK(drive.least_m > 0.0F);
  }
}

TEST_CASE("ORCA turns to the side on which the velocity obstacle is left with least change") {
  // Relative velocity (0.6, 0); the cone of a mover at (1.4, 0.2) with 0.3 + 0.27 + 0.05 m is left over its right leg.
  const Floor floor;
  const motion::RobotState now{0.0F, 0.0F, 0.0F, 0.6F, 0.0F, 0.0F};
  const Track left = standing_at(1.4, 0.2), right = standing_at(1.4, -0.2), far = standing_at(2.0, 1.0);
  CHECK(orca(floor.scene(now, {&left, 1})).w < -0.1F);
  CHECK(orca(floor.scene(now, {&right, 1})).w > 0.1F);
  // Cut-off disc of (2.0, 1.0): centre (0.8, 0.4), radius 0.248; (0.6, 0) is 0.447 from it: nothing changes.
  CHECK(std::fabs(orca(floor.scene(now, {&far, 1})).w) < 0.06F);
}

TEST_CASE("a robot enclosed by movers waits") {
  const Floor floor;
  std::vector<Track> ring;
  for (int k = 0; k < 12; ++k) {
    const double angle = 2.0 * kPi * k / 12.0;
    ring.push_back(standing_at(0.9 * jaywalk::cos(angle), 0.9 * jaywalk::sin(angle)));
  }
  CHECK(replan(floor.scene({}, ring)).v == 0.0F);
}
