#include "firmware/control_setup.h"

#include <string>

#include "apps/rivals/paper_mode.h"
#include "hal/types/errors.h"
#include "tests/support/catch.h"
#include "tests/support/text.h"

using namespace jaywalk;

TEST_CASE("a setup comes back from its text bit for bit") {
  ControlSetup setup;
  setup.model = wheelchair();
  setup.mode = PlanMode::kPaper;
  setup.backend = Backend::kCpu;
  setup.start = {1.0 / 3.0, -2.0 / 7.0, 0.1};
  setup.goal = {1e-17, 12345.678901234567};
  setup.wheels = false;
  setup.comfort_distance_m = 1.5;
  setup.given_movers = true;
  setup.unix_from_loop = std::chrono::seconds(1'700'000'000) + Duration{7};
  (void)setup.model.laser.blanked.push_back({1.0 / 3.0, 0.5});
  const ControlSetup back = setup_from_text(to_text(setup), "here");
  CHECK(to_text(back) == to_text(setup));
  CHECK(back.start == setup.start);
  CHECK(back.goal == setup.goal);
  CHECK(back.mode == PlanMode::kPaper);
  CHECK_FALSE(back.wheels);
  CHECK(back.comfort_distance_m == 1.5);
  CHECK(back.given_movers);
  CHECK(back.unix_from_loop == setup.unix_from_loop);
  REQUIRE(back.model.laser.blanked.size() == 1);
  CHECK(back.model.laser.blanked[0].from_rad == 1.0 / 3.0);
  CHECK(back.model.laser.blanked[0].to_rad == 0.5);
}

TEST_CASE("a setup without wall clock and blanked sectors says nothing of them") {
  const std::string text = to_text(ControlSetup{});
  CHECK_FALSE(holds(text, "unix_from_loop"));
  CHECK(setup_from_text(text, "here").model.laser.blanked.empty());
}

TEST_CASE("movers come from outside where the setup says so, and in mode paper") {
  ControlSetup setup;
  CHECK_FALSE(setup.sees_given_movers());
  setup.given_movers = true;
  CHECK(setup.sees_given_movers());
  setup = {};
  setup.mode = PlanMode::kPaper;
  CHECK(setup.sees_given_movers());
}

TEST_CASE("mode paper is refused where its planner is not, and plans by it where it is") {
  ControlSetup setup;
  setup.mode = PlanMode::kPaper;
  setup.backend = Backend::kCpu;
  CHECK_THROWS_AS(make_planner(setup), StartupError);
  equip(setup);
  CHECK(make_planner(setup).planner->view_field().of == FieldView::Of::kPotential);
}

TEST_CASE("text that is no setup is refused with its place") {
  CHECK_THROWS_AS(setup_from_text("{}", "a.jwr"), StartupError);
  CHECK(refusal_of([] { return setup_from_text("nonsense", "a.jwr"); }).starts_with("a.jwr: "));
}

TEST_CASE("a robot plans with the circle that holds it, if that is little wider than the one inside it") {
  ControlSetup setup;
  setup.model = p3dx();
  CHECK(setup.mover_radius_m() == Approx(0.36));  // 0.21 + 0.15; its corners: 0.368 m
  CHECK_FALSE(setup.has_long_body());
  setup.model = wheelchair();
  CHECK(setup.has_long_body());
  CHECK(setup.mover_radius_m() == Approx(0.475));  // 0.325 + 0.15
  setup.constant_speed = true;                     // it can neither stop nor back out
  CHECK_FALSE(setup.has_long_body());
}
