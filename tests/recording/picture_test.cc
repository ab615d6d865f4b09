#include <cmath>
#include <limits>

#include "apps/report/picture/canvas.h"
#include "apps/report/picture/run_layers.h"
#include "apps/report/picture/scene.h"
#include "hal/types/errors.h"
#include "tests/recording/made_scene.h"
#include "tests/recording/scratch.h"
#include "tests/support/catch.h"

namespace jaywalk {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

std::string png(const Scratch& scratch, const PictureScene& scene) {
  draw_picture(scene, scratch.path("run.png"));
  return scratch.read("run.png");
}

/// Width and height in the PNG's first chunk: 4 bytes each, big endian, from byte 16 on.
std::pair<int, int> size_of(const std::string& png) {
  const auto number = [&](std::size_t at) {
    int value = 0;
    for (std::size_t i = at; i < at + 4; ++i) value = value * 256 + static_cast<unsigned char>(png[i]);
    return value;
  };
  return {number(16), number(20)};
}

TEST_CASE("the same scene gives the same bytes, at least 1600 pixels wide") {
  const Scratch scratch;
  const std::string first = png(scratch, made_scene());
  CHECK(first.substr(0, 8) == "\x89PNG\r\n\x1A\n");
  CHECK(size_of(first).first >= 1600);
  CHECK(first == png(scratch, made_scene()));
  PictureScene other = made_scene();
  other.goal->x -= 2.0;
  CHECK_FALSE(first == png(scratch, other));
}

TEST_CASE("an empty scene, a scene of one point and a tower draw all the same, to a file that can be written") {
  const Scratch scratch;
  PictureScene scene;
  scene.extent = extent_of(scene);
  CHECK_FALSE(png(scratch, scene).empty());
  scene.driven.push_back({time_from_seconds(5), {1, 2, 3}});
  scene.extent = extent_of(scene);
  CHECK(scene.extent.low.x < 1.0);
  CHECK_FALSE(png(scratch, scene).empty());
  scene.goal = Vec2{1, 40};
  scene.extent = extent_of(scene);
  CHECK(size_of(png(scratch, scene)).first >= 1600);
  CHECK_THROWS_AS(draw_picture(scene, "/nowhere/at/all/run.png"), StartupError);
}

TEST_CASE("cairo that is not installed, or lacks a function, is none") {
  CHECK(load_cairo("libno-such-cairo.so.2") == nullptr);
  CHECK(load_cairo("libz.so.1") == nullptr);
  CHECK(can_draw_pictures());
}

TEST_CASE("pixels a metre are set by the side that is short of room, y points up") {
  // 10 m x 5 m into 1000 x 800 pixels: 100 pixels a metre.
  const MapFrame to_sheet({{0, 0}, {10, 5}}, {50, 60}, {1000, 800});
  CHECK(to_sheet.pixels(1.0) == Approx(100.0));
  CHECK(to_sheet({0, 5}) == Vec2{50, 60});
  CHECK(to_sheet({10, 0}) == Vec2{1050, 560});
}

TEST_CASE("ranks spread what is finite evenly and pass over the rest") {
  const std::vector<float> rank = ranks({100.0F, kNan, 1.0F, kInf, 2.0F, 2.0F});
  CHECK(rank[0] == 0.75F);
  CHECK(std::isnan(rank[1]));
  CHECK(rank[2] == 0.0F);
  CHECK(std::isnan(rank[3]));
  CHECK(rank[4] == 0.25F);
  CHECK(rank[5] == 0.25F);
}

TEST_CASE("a contour runs where the level lies between cells") {
  // Columns of 0 and 1: the level 0.25 runs a quarter of the way across, from row 0 to row 2.
  const Polyline pieces = contour({0, 1, 0, 1, 0, 1}, 2, 3, 0.25F);
  REQUIRE(pieces.size() == 4);
  for (const Vec2 p : pieces) CHECK(p.x == 0.25);
  CHECK(contour({0, 1, 0, kNan}, 2, 2, 0.5F).empty());
  CHECK(contour({0, 0, 0, 0}, 2, 2, 0.5F).empty());
  CHECK(contour({0, 1, 1, 0}, 2, 2, 0.5F).size() == 4);  // a saddle: two pieces
}

TEST_CASE("a crop keeps the cells whose centres lie inside") {
  // Cells of 1 m from (10, 20): numbered 0 to 5, row by row. x of 10.6 to 12.4 holds the centre 11.5
  // only, y of 19 to 30 both rows.
  const FieldRaster field{{10, 20}, 3, 2, 1.0, {0, 1, 2, 3, 4, 5}};
  const FieldRaster part = cropped(field, {{10.6, 19}, {12.4, 30}});
  CHECK(part.low == Vec2{11, 20});
  CHECK(part.width == 1);
  CHECK(part.psi == std::vector<float>{1, 4});
  CHECK(cropped(field, {{50, 50}, {60, 60}}).psi.empty());
}

TEST_CASE("only tracks that were moving and left their place are shown") {
  Trail track{
      1, 0.2, true, {{time_from_seconds(0), {0, 0}}, {time_from_seconds(9), {1, 0}}, {time_from_seconds(10), {0, 0}}}};
  CHECK(went_somewhere(track));
  track.flagged = false;
  CHECK_FALSE(went_somewhere(track));
  CHECK_FALSE(went_somewhere({2, 0.2, true, {{time_from_seconds(0), {0, 0}}, {time_from_seconds(9), {0.5, 0}}}}));
}

TEST_CASE("stray hits do not shrink the picture, walls are shown whole") {
  // 1,000 cells in a square of 10 m and one 90 m away: the one is beyond half a percent.
  PictureScene scene;
  for (int i = 0; i < 1000; ++i) scene.occupied.push_back({0.01 * i, 0.01 * (999 - i)});
  scene.occupied.push_back({90, 90});
  CHECK(extent_of(scene).high.x < 12.0);
  scene.walls.push_back({{0, 0}, {40, 0}});
  CHECK(extent_of(scene).high.x > 40.0);
}

TEST_CASE("cells seen occupied are taken from round the drive") {
  EvidenceMap map(64, 0.1, {0, 0});
  map.add({5, 5}, 60);
  map.add({30, 30}, 60);
  map.add({6, 6}, 1);
  const auto cells = occupied_cells(map, {{time_from_seconds(0), {0, 0, 0}}}, 1.0);
  REQUIRE(cells.size() == 1);
  CHECK(cells[0].x == Approx(0.55));
  CHECK(occupied_cells(map, {}, 1.0).empty());
}

class FixedPlanner final : public Planner {
 public:
  void submit(const PlanRequest& /*request*/) noexcept override {}
  const Plan& collect() noexcept override { return plan; }
  FieldView view_field() const override {
    ++asked;
    return {.low = {-2, 3}, .width = 2, .height = 2, .cell_m = 0.1, .psi = psi};
  }
  const char* backend() const noexcept override { return "none"; }

  Plan plan;
  std::vector<float> psi{1, 2, 3, 4};
  mutable int asked = 0;
};

TEST_CASE("the busiest moment is the plan with most expected near the robot") {
  const auto planner = std::make_unique<FixedPlanner>();
  Plan& plan = planner->plan;
  BusiestMoment busiest;
  plan.status = PlanStatus::kNoPath;
  busiest.consider(plan, *planner, {}, {});
  CHECK_FALSE(busiest.moment().has_value());

  plan.status = PlanStatus::kOk;
  plan.stamp = time_from_seconds(1);
  busiest.consider(plan, *planner, {}, {});
  REQUIRE(busiest.moment().has_value());
  CHECK(busiest.moment()->field.low.x == Approx(-0.2));
  CHECK(busiest.moment()->field.psi == planner->psi);

  plan.stamp = time_from_seconds(2);
  REQUIRE(plan.predictions.push_back({1, {1, 0}, 0.5}));
  busiest.consider(plan, *planner, {}, {});
  plan.stamp = time_from_seconds(3);
  plan.predictions[0].position_in_map = {5, 0};
  busiest.consider(plan, *planner, {}, {});
  CHECK(busiest.moment()->t == time_from_seconds(2));
  CHECK(planner->asked == 2);
}

}  // namespace
}  // namespace jaywalk
