// Where no way is found for ten seconds, what may have gone while nothing looked there is in nobody's way any more.
#include <filesystem>
#include <fstream>

#include "tests/firmware/failing_planner.h"
#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

constexpr Vec2 kBeside{1.6, 4.6};  // left of the way, and soon behind a laser that looks ahead

/// A robot with a laser ahead drives past a pedestrian, who stands for six seconds and then goes, unseen.
void add_pedestrian(sim::Scenario& scenario) {
  const std::filesystem::path file = std::filesystem::temp_directory_path() / "jaywalk_no_way_test.csv";
  std::ofstream out(file);
  out << "t_s,id,x_m,y_m\n";
  for (const int t_s : {0, 6}) out << t_s << ",1," << kBeside.x << ',' << kBeside.y << '\n';
  scenario.wanderers.clear();
  scenario.recorded.push_back({.file = file});
  scenario.model.laser.fov_rad = kPi;
}

bool remembers_pedestrian(const SimulatedDrive& drive) {
  const EvidenceMap& still = drive.loop().tracker().still();
  bool some = false;
  for (int i = -3; i <= 3; ++i) {
    for (int j = -3; j <= 3; ++j) some = some || still.occupied(still.cell_at(kBeside + Vec2{0.1 * i, 0.1 * j}));
  }
  return some;
}

}  // namespace

TEST_CASE("a pedestrian where nothing looks any more is forgotten after ten seconds at rest without a path") {
  test::FailingDrive drive(add_pedestrian);
  drive.drive(6.0);
  const bool fails = GENERATE(false, true);
  drive.fail(fails);
  drive.drive(8.0);
  CHECK(remembers_pedestrian(drive));
  drive.drive(6.0);
  CHECK((drive.tick().verdict.permitted == Twist2{}) == fails);
  CHECK(remembers_pedestrian(drive) != fails);
}
