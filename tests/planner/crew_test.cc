// Many threads that share every step give the bytes of one that takes them all: the order and the barriers that a
// device runs in one kernel, on the CPU. Built with a thread sanitizer this is where a missing barrier shows.
#include <cstdio>
#include <memory>

#include "planner/field/map_field_on.h"
#include "tests/planner/crew_on_cpu.h"
#include "tests/planner/field_rig.h"
#include "tests/planner/same_bytes.h"
#include "tests/planner/shaped_maps.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::test;

namespace {

TestMap boxes(std::int32_t side, std::uint64_t seed) {
  TestMap map("boxes", side);
  Random random(seed);
  for (std::int32_t k = 0; k < side / 5; ++k) {
    const std::int32_t i = random.below(side - 4), j = random.below(side - 4);
    map.box(i, j, i + 2 + random.below(8), j + 2 + random.below(8));
  }
  map.box(4, 4, 12, 12, 0), map.box(side - 14, side - 14, side - 4, side - 4, 0);
  return map;
}

/// Cold and warm on one map after the other, against one thread.
template <class Crew>
void check_fields(std::int32_t side, int maps) {
  FieldRig<> serial(side);
  FieldRig<Crew> crew(side);
  const std::int32_t goal = serial.grid.at(side - 9, side - 9), n = serial.grid.cells();
  for (int seed = 1; seed <= maps; ++seed) {
    const TestMap map = boxes(side, static_cast<std::uint64_t>(seed));
    serial.load(map, 1.0F, goal);
    crew.load(map, 1.0F, goal);
    CHECK(same(serial.arrays().clearance, crew.arrays().clearance, n));
    CHECK(same(serial.arrays().rate, crew.arrays().rate, n));
    CHECK(same(serial.arrays().cost, crew.arrays().cost, n));
    for (const field::From from : {field::From::kNothing, field::From::kLast, field::From::kStartOnly}) {
      const field::FieldQuality a = serial.pass.solve(serial.grid, goal, from, serial.psi);
      const field::FieldQuality b = crew.pass.solve(crew.grid, goal, from, crew.psi);
      CHECK(a.joined > n / 4);
      CHECK(a.joined == b.joined);
      CHECK(a.pits == b.pits);
      CHECK(a.cycles == b.cycles);
      CHECK(same(serial.psi, crew.psi, n));
      CHECK(same(serial.arrays().correction, crew.arrays().correction, n));
      CHECK(same(serial.arrays().index, crew.arrays().index, n));
    }
  }
}

}  // namespace

TEST_CASE("a crew of 1, 2, 3 or 7 threads solves to the bytes of one thread, whoever takes the small steps") {
  check_fields<CrewOnCpu<1, 1, 8192>>(64, 1);
  check_fields<CrewOnCpu<1, 2, 0>>(64, 1);        // every step is the whole crew's
  check_fields<CrewOnCpu<3, 1, 500>>(64, 2);      // three blocks of one thread; the first takes small steps
  check_fields<CrewOnCpu<1, 7, 1 << 20>>(64, 1);  // one block that takes all
  check_fields<CrewOnCpu<2, 3, 300>>(64, 2);
  check_fields<CrewOnCpu<2, 2, 8192>>(128, 1);  // as on a device: half a board of 128 is the first block's
}

TEST_CASE("a crew solves a large window, whose blocks go down twice in a cycle, as one thread does") {
  using Crew = CrewOnCpu<1, 2, 8192>;
  field::MapFieldOn<Crew> crew(large_map(), std::make_unique<Crew>());
  check_field(large_map(), crew);
}

TEST_CASE("a crew plans among movers to the bytes of one thread, plan by plan") {
  check_plans<CrewOnCpu<2, 2, 1000>>(boxes(64, 3), 5);
}

TEST_CASE("a crew solves maps of every shape as one thread does") {
  using Crew = CrewOnCpu<2, 2, 700>;
  for (const field::CellMap& map : shaped_maps()) {
    field::MapFieldOn<Crew> crew(map, std::make_unique<Crew>());
    check_field(map, crew);
  }
}

TEST_CASE("a goal that cannot be reached from the robot's place is not solved, by a crew as by one thread") {
  FieldRig<> serial(64);
  FieldRig<CrewOnCpu<2, 2, 700>> crew(64);
  TestMap map("closed", 64);
  map.box(30, 0, 32, 64);
  const std::int32_t goal = serial.grid.at(50, 12);
  serial.load(map, 1.0F, goal);
  crew.load(map, 1.0F, goal);
  // Free cells on the goal's side begin at column 33: a disc of 4 round column 28 does not touch them, one of 5 does.
  for (const field::Disc robot : {field::Disc{28, 12, 4}, field::Disc{-20, 12, 10}, field::Disc{28, 12, 5}}) {
    const auto a = serial.pass.solve(serial.grid, goal, field::From::kNothing, robot, serial.psi);
    const auto b = crew.pass.solve(crew.grid, goal, field::From::kNothing, robot, crew.psi);
    CHECK(a.done);
    CHECK(b.done);
    CHECK(a.joined == b.joined);
    CHECK((a.joined > 0) == (robot.radius == 5));
  }
}

TEST_CASE("how often a crew meets in a solve of 256 cells a side, to the bytes of one thread") {
  using Crew = CrewOnCpu<2, 1, 8192>;  // as on a device, half a board of 128 is the first block's
  FieldRig<> serial(256);
  FieldRig<Crew> rig(256);
  const std::int32_t goal = rig.grid.at(243, 243), n = rig.grid.cells();
  std::int64_t crew_met = 0, block_met = 0;
  const auto tell = [&](const char* what) {
    crew_met = rig.executor.crew_meetings() - crew_met, block_met = rig.executor.block_meetings() - block_met;
    std::printf("  %s: the crew %lld times, its first block alone %lld\n", what, static_cast<long long>(crew_met),
                static_cast<long long>(block_met));
    const std::int64_t met = crew_met;
    crew_met = rig.executor.crew_meetings(), block_met = rig.executor.block_meetings();
    return met;
  };
  for (const TestMap& map : {open_room(), office(), serpentine(15)}) {
    std::printf("%s\n", map.name.c_str());
    for (std::size_t c = 0; c < map.wall.size(); ++c) rig.arrays().occupants[c] = map.wall[c];
    (void)rig.pass.clear(rig.grid, 3.0F, field::kWall);
    CHECK(tell("clearance") <= 3);
    (void)rig.pass.start(rig.grid, goal);
    CHECK(tell("start field") <= 3);
    (void)rig.pass.solve(rig.grid, goal, field::From::kNothing, rig.psi);
    CHECK(tell("cold") <= 54);
    (void)rig.pass.solve(rig.grid, goal, field::From::kLast, rig.psi);
    CHECK(tell("warm") <= 16);
    serial.load(map, 3.0F, goal);
    (void)serial.pass.solve(serial.grid, goal, field::From::kNothing, serial.psi);
    (void)serial.pass.solve(serial.grid, goal, field::From::kLast, serial.psi);
    CHECK(same(serial.arrays().cost, rig.arrays().cost, n));
    CHECK(same(serial.psi, rig.psi, n));
    CHECK(same(serial.arrays().index, rig.arrays().index, n));
  }
}
