#include "hal/sim/walls.h"

#include <algorithm>

#include "hal/sim/free_grid.h"
#include "hal/sim/random.h"
#include "tests/sim/made_worlds.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::sim;

namespace {

constexpr double kRoot2 = 1.4142135623730951;

/// 8 x 4 cells of half a metre; one solid cell, column 6 of the row second from below.
Walls one_cell(const std::string& origin) {
  folder().write("cell.pgm",
                 "P2 8 4 255 "
                 "255 255 255 255 255 255 255 255 "
                 "255 255 255 255 255 255 255 255 "
                 "255 255 255 255 255 255   0 255 "
                 "255 255 255 255 255 255 255 255");
  return Walls(load_wall_map(MapKind::kYaml, folder().write("cell.yaml", "image: cell.pgm\nresolution: 0.5\norigin: " +
                                                                             origin + "\nnegate: 0\n")));
}

}  // namespace

TEST_CASE("rays end at the room's walls, 7 m ahead, 6 root 2 m along the diagonal, or meet nothing in their range") {
  const Walls walls = room();
  CHECK(walls.cast({3, 4}, {1, 0}, 25.0) == Approx(7.0));
  CHECK(walls.cast({3, 4}, {-1, 0}, 25.0) == Approx(3.0));
  CHECK(walls.cast({3, 4}, {0, -1}, 25.0) == Approx(4.0));
  CHECK(walls.cast({3, 4}, {kRoot2 / 2, kRoot2 / 2}, 25.0) == Approx(6 * kRoot2));  // at (9, 10)
  CHECK(walls.cast({3, 4}, {1, 0}, 6.9) == kInfinity);
  CHECK(walls.cast({3, 4}, {1, 0}, 7.1) == Approx(7.0));
}

TEST_CASE("a solid cell stops rays at its four sides") {
  const Walls walls = one_cell("[-1.0, -2.0, 0.0]");  // the cell: x 2.0 to 2.5, y -1.5 to -1.0
  CHECK(walls.cast({0.0, -1.25}, {1, 0}, 25.0) == Approx(2.0));
  CHECK(walls.cast({4.0, -1.25}, {-1, 0}, 25.0) == Approx(1.5));
  CHECK(walls.cast({2.25, 0.0}, {0, -1}, 25.0) == Approx(1.0));
  CHECK(walls.cast({0.0, -0.9}, {1, 0}, 25.0) == kInfinity);
  CHECK(walls.distance({2.2, -1.2}, 1.0) == 0.0);
  CHECK(walls.distance({2.25, 0.0}, 5.0) == Approx(1.0));
}

TEST_CASE("a map turned by a quarter has its cell on the left") {
  // In the picture the cell spans x 3.0 to 3.5, y 0.5 to 1.0; turned: x -1.0 to -0.5, y 3.0 to 3.5.
  const Walls walls = one_cell("[0.0, 0.0, 1.5707963267948966]");
  CHECK(walls.cast({-0.75, 0.0}, {0, 1}, 25.0) == Approx(3.0));
  CHECK(walls.distance({-0.75, 3.2}, 1.0) == 0.0);
}

TEST_CASE("a pillar of 1 m radius 5 m ahead: 4.0 m through its middle, 4.2 m when 0.6 m aside") {
  const Walls walls(load_cylinder_map(folder().write("pillar.txt", "# x y radius\n5 0 1\n")));
  CHECK(walls.cast({0, 0}, {1, 0}, 25.0) == Approx(4.0));
  CHECK(walls.cast({0, 0.6}, {1, 0}, 25.0) == Approx(4.2));  // sqrt(1 - 0.36) = 0.8
  CHECK(walls.cast({0, 1.1}, {1, 0}, 25.0) == kInfinity);
  CHECK(walls.cast({5.5, 0}, {1, 0}, 25.0) == 0.0);
}

TEST_CASE("buckets lose no wall: 5000 rays agree with trying every segment") {
  const Walls walls(load_wall_map(MapKind::kYaml, JAYWALK_OWN_MAPS "/map1.yaml"));
  Random random(1, Purpose::kPlacement);
  for (int k = 0; k < 5000; ++k) {
    const Vec2 from{random.uniform(-1.0, 27.0), random.uniform(-1.0, 27.0)};
    const Vec2 along = direction(random.uniform(-kPi, kPi));
    double nearest = kInfinity;
    for (const WallSegment& s : walls.segments()) nearest = std::min(nearest, hit_range(from, along, s));
    REQUIRE(walls.cast(from, along, 100.0) == nearest);
  }
}

TEST_CASE("a square robot turned by 45 degrees stands half a diagonal nearer to the wall") {
  const Walls walls = room();
  const Footprint square{.front_m = 0.5, .rear_m = 0.5, .half_width_m = 0.5};
  CHECK(walls.clearance(square, {5, 4, 0}) == Approx(3.5));
  CHECK(walls.clearance(square, {5, 4, kPi / 4}) == Approx(4.0 - kRoot2 / 2));
  CHECK(walls.clearance(square, {5, 0.5, 0}) == Approx(0.0).margin(1e-12));
  CHECK(walls.clearance(square, {5, 0.3, 0}) == 0.0);
}

TEST_CASE("clearance counts from the footprint, whose front may be far ahead of the axle") {
  const Walls walls = room();
  CHECK(walls.clearance(wheelchair().footprint, {7, 5, 0}) == Approx(10.0 - 7.75));
  CHECK(walls.clearance(wheelchair().footprint, {7, 5, kPi}) == Approx(10.0 - 7.35));
}

TEST_CASE("clearance finds what is far away, and nothing where there is nothing") {
  WallMap lone;
  lone.discs.push_back({{103.0, 4.0}, 0.5});
  CHECK(Walls(lone).clearance({1.0, 1.0, 1.0}, {0, 0, 0}) ==
        Approx(102.05 - 0.5).margin(0.01));  // |(102, 3)| = 102.044
  CHECK(Walls(WallMap{}).clearance({1.0, 1.0, 1.0}, {0, 0, 0}) == kInfinity);
}

TEST_CASE("clearance of a long robot agrees with trying every wall by itself") {
  const Walls walls(load_wall_map(MapKind::kYaml, JAYWALK_OWN_MAPS "/map1.yaml"));
  const Footprint longish{.front_m = 2.0, .rear_m = 1.0, .half_width_m = 0.2};
  std::vector<Walls> each;
  for (const WallSegment& s : walls.segments()) each.emplace_back(WallMap{{s}, {}, {}});
  Random random(2, Purpose::kPlacement);
  for (int k = 0; k < 300; ++k) {
    const Pose2 pose{random.uniform(0.5, 25.0), random.uniform(0.5, 25.0), random.uniform(-kPi, kPi)};
    double nearest = kInfinity;
    for (const Walls& wall : each) nearest = std::min(nearest, wall.clearance(longish, pose));
    if (walls.distance(pose.position(), 1.0) > 0.0) REQUIRE(walls.clearance(longish, pose) == Approx(nearest));
  }
}

TEST_CASE("a wall's end between two corners of the robot is near its side") {
  WallMap map;
  map.segments.push_back({{0.0, 1.0}, {0.0, 5.0}});
  const Footprint longish{.front_m = 1.0, .rear_m = 1.0, .half_width_m = 0.25};
  CHECK(Walls(map).clearance(longish, {0, 0, 0}) == Approx(0.75));
  CHECK(Walls(map).clearance(longish, {0, 0, kPi / 2}) == Approx(0.0).margin(1e-12));
}

TEST_CASE("the shortest path round a wall's end hugs it at the robot's radius") {
  // From (2, 2) over the end at (5, 8) to (8, 2): two tangents of sqrt(45 - r r) and r (2 atan 2 + 2 asin(r / sqrt 45))
  // on the circle: for r = 0.19 13.411 + 0.431 = 13.842.
  const Walls walls = room("5000 0 5000 8000\n");
  CHECK(FreeGrid(walls, 0.19, {2, 2}, {8, 2}).shortest_path_m() == Approx(13.842).epsilon(0.01));
}

TEST_CASE("in the open the shortest path is the straight line") {
  const Walls walls = room();
  CHECK(FreeGrid(walls, 0.19, {1, 1}, {9, 7}).shortest_path_m() == Approx(10.0).epsilon(0.001));
}

TEST_CASE("where the robot does not fit there is no path") {
  const Walls walls = room("5000 0 5000 9650\n");  // a gap of 0.35 m
  const FreeGrid grid(walls, 0.19, {2, 2}, {8, 2});
  CHECK(grid.shortest_path_m() == kInfinity);
  CHECK(grid.reachable({2, 8}));
  CHECK_FALSE(grid.reachable({8, 8}));
  CHECK(FreeGrid(walls, 0.12, {2, 2}, {8, 2}).shortest_path_m() < 20.0);
}
