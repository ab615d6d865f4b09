// What the loop makes of plans without a path: one is bridged, a second of them stops the robot. Where no way is found
// for ten seconds, what may have gone while nothing looked there is in nobody's way any more.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>

#include "planner/cost_to_go/planner.h"
#include "tests/firmware/simulated_drive.h"
#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

/// Plans, and says that it found no path while `fails`.
class FailingPlanner final : public Planner {
 public:
  explicit FailingPlanner(const PlannerConfig& config) : planner_(make_cpu_planner(config)) {}
  void submit(const PlanRequest& request) noexcept override { planner_->submit(request); }
  [[nodiscard]] const Plan& collect() noexcept override {
    const Plan& plan = planner_->collect();
    if (!fails) return plan;
    failed_.stamp = plan.stamp;
    failed_.sequence = plan.sequence;
    failed_.status = PlanStatus::kNoPath;
    return failed_;
  }
  [[nodiscard]] FieldView view_field() const override { return planner_->view_field(); }
  [[nodiscard]] const char* backend() const noexcept override { return planner_->backend(); }
  bool fails = false;

 private:
  std::unique_ptr<Planner> planner_;
  Plan failed_;
};

/// The drive "crossing" by a planner that can fail.
struct FailingDrive : SimulatedDrive {
  explicit FailingDrive(const Edit& edit, bool constant_speed = false)
      : SimulatedDrive("crossing", 1, edit, PlanMode::kFull, "", [&](ControlSetup& setup) {
          setup.constant_speed = constant_speed;
          setup.make_planner = [](const ControlSetup& of) {
            return ChosenPlanner{std::make_unique<FailingPlanner>(of.planner()), ""};
          };
        }) {}
  void fail(bool fails) { dynamic_cast<FailingPlanner&>(planner()).fails = fails; }
};

struct Bench {
  explicit Bench(bool constant_speed)
      : drive([](sim::Scenario& scenario) { scenario.wanderers.clear(); }, constant_speed) {
    ticks(200);  // four seconds: at speed
  }
  TickRecord ticks(int count) {
    TickRecord last;
    for (int k = 0; k < count; ++k) {
      last = drive.tick();
      hardest_mps = std::max(hardest_mps, v_mps - last.verdict.permitted.v_mps);
      v_mps = last.verdict.permitted.v_mps;
    }
    return last;
  }

  FailingDrive drive;
  double v_mps = 0.0, hardest_mps = 0.0;  ///< permitted; the most that it fell in a tick
};

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

TEST_CASE("one plan without a path is bridged within comfort, a second of them is a standstill") {
  Bench bench(false);
  const double before = bench.v_mps;
  REQUIRE(before > 0.5);
  bench.drive.fail(true);
  const TickRecord once = bench.ticks(4);  // a scan's time
  CHECK_FALSE(has(once.verdict.reasons, Reason::kPlanStale));
  CHECK(bench.v_mps > before - 0.06);
  bench.drive.fail(false);
  bench.ticks(50);
  CHECK(bench.v_mps > 0.5);
  CHECK(bench.hardest_mps <= bench.drive.setup().model.limits.max_accel_mps2 * 0.02 + 1e-9);
  bench.drive.fail(true);
  const TickRecord last = bench.ticks(60);
  CHECK(has(last.verdict.reasons, Reason::kPlanStale));
  bench.ticks(60);
  CHECK(bench.v_mps == 0.0);
}

TEST_CASE("at constant speed, without a ramp of its own, a robot stops at the first plan without a path") {
  Bench bench(true);
  REQUIRE(bench.v_mps > 0.5);
  bench.drive.fail(true);
  const TickRecord last = bench.ticks(4);
  CHECK(has(last.verdict.reasons, Reason::kPlanStale));
  CHECK(bench.hardest_mps == Approx(bench.drive.setup().model.limits.brake_mps2 * 0.02));
}

TEST_CASE("a pedestrian where nothing looks any more is forgotten after ten seconds at rest without a path") {
  FailingDrive drive(add_pedestrian);
  drive.drive(6.0);
  const bool fails = GENERATE(false, true);
  drive.fail(fails);
  drive.drive(8.0);
  CHECK(remembers_pedestrian(drive));
  drive.drive(6.0);
  CHECK((drive.tick().verdict.permitted == Twist2{}) == fails);
  CHECK(remembers_pedestrian(drive) != fails);
}
