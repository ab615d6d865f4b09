#include "hal/maps/wall_map.h"
#include "tests/sim/made_worlds.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::sim;

namespace {

const std::string kYaml = "image: two.pgm\nresolution: 0.1\norigin: [0, 0, 0]\nnegate: 0\n";

}  // namespace

TEST_CASE("bad maps are refused with file, line and cause") {
  folder().write("two.pgm", "P2 2 1 255 0 255");
  folder().write("cut.pgm", "P5 4 4 255 abc");
  folder().write("odd.pgm", "P2 2 1 255 0 256");
  folder().write("huge.pgm", "P2 100000 100000 255 0");
  folder().write("deep.pgm", "P2 1 1 70000 0");
  folder().write("size.pgm", "P5 100");
  folder().write("text.png", "hello");
  const auto with_image = [](const std::string& image) {
    return "image: " + image + "\nresolution: 0.1\norigin: [0, 0, 0]\n";
  };
  const auto of = [](MapKind kind) {
    return [kind](const std::string& text) {
      return refusal_of([&] { return load_wall_map(kind, folder().write("bad", text)); });
    };
  };
  check_refused({{"resolution: 0.1\norigin: [0,0,0]\n", "bad:1: image is missing"},
                 {with_image("none.pgm"), "bad:1: image names no file"},
                 {"image: two.pgm\norigin: [0,0,0]\n", "bad:1: resolution is missing"},
                 {"image: two.pgm\nresolution: 0\norigin: [0,0,0]\n", "bad:2: resolution"},
                 {"image: two.pgm\nresolution: .nan\norigin: [0,0,0]\n", "bad:2: resolution"},
                 {"image: two.pgm\nresolution: fine\n", "bad:2: resolution has the wrong type"},
                 {"image: two.pgm\nresolution: 0.1\norigin: [0,0]\n", "bad:3: origin"},
                 {"image: two.pgm\nresolution: 0.1\norigin: [.inf,0,0]\n", "bad:3: origin"},
                 {kYaml + "occupied_thresh: 65\n", "bad:5: occupied_thresh is outside 0 to 1"},
                 {kYaml + "free_thresh: 0.9\n", "bad:5: free_thresh is over"},
                 {kYaml + "mode: binary\n", "bad:5: mode is none of trinary, scale, raw"},
                 {"image: [two.pgm\n", "bad:"},
                 {"- 1\n- 2\n", "bad:1: holds no keys"},
                 {with_image("cut.pgm"), "cut.pgm: damaged at pixel 3"},
                 {with_image("odd.pgm"), "odd.pgm: damaged at pixel 1"},
                 {with_image("huge.pgm"), "huge.pgm: 100000 x 100000 are more than 3,000 million pixels"},
                 {with_image("deep.pgm"), "deep.pgm: a greatest grey value"},
                 {with_image("text.png"), "text.png: neither PNG nor PGM"},
                 {kYaml + "resolution: 0.5\n", "bad:5: resolution stands twice"},
                 {std::string("P5 \"\\\0", 6), "bad: is a picture"},
                 {with_image("size.pgm"), "size.pgm: no size"}},
                of(MapKind::kYaml));
  check_refused({{"LINES\n0 0 1 1\n", "bad:1: does not begin with 2D-Map"},
                 {"", "bad: does not begin with 2D-Map"},
                 {"2D-Map\nLINES\n0 0 1\n", "bad:3: \"0 0 1\" is not 4 numbers"},
                 {"2D-Map\nLINES\n0 0 1 x\n", "bad:3: "},
                 {"2D-Map\nNumLines: 0\n", "bad:2: has neither LINES nor DATA"},
                 {"2D-Map\nNumLines: 2\nLINES\n0 0 1 1\n", "bad:4: ends before its NumLines"},
                 {"2D-Map\nNumPoints: 2\nDATA\n0 0\n", "bad:4: ends before its NumPoints"},
                 {"2D-Map\nDATA\n1e30 0\n", "bad:3: "}},
                of(MapKind::kAria));
  check_refused({{"# x y r\n1 2\n", "bad:2: \"1 2\" is not 3 numbers"},
                 {"1 2 -0.1\n", "bad:1: a cylinder needs a radius above 0"},
                 {"# none\n", "bad:1: holds no cylinder"}},
                of(MapKind::kCylinders));
}

TEST_CASE("a byte order mark is no part of a map") {
  const std::string mark = "\xEF\xBB\xBF";
  CHECK(load_aria_map(folder().write("m.map", mark + "2D-Map\nLINES\n0 0 1 1\n")).segments.size() == 1);
  CHECK(load_cylinder_map(folder().write("c.txt", mark + "1 2 0.1\n")).discs.size() == 1);
}

TEST_CASE("a map that is not there is refused, whatever its kind") {
  for (const MapKind kind : {MapKind::kYaml, MapKind::kAria, MapKind::kCylinders}) {
    CHECK(holds(refusal_of([&] { return load_wall_map(kind, "/nowhere/at.all"); }), "/nowhere/at.all: "));
  }
}

TEST_CASE("grey between the thresholds is unknown and no wall, darker is wall, negate turns it round") {
  folder().write("grey.pgm", "P2 4 1 255  0 80 205 254");  // occupancies 1.0, 0.69, 0.2, 0.004
  const auto solid = [&](const std::string& more) {
    const auto file = folder().write("grey.yaml", "image: grey.pgm\nresolution: 1\norigin: [0, 0, 0]\n" + more);
    return load_raster(file).solid;
  };
  using Cells = std::vector<std::uint8_t>;
  CHECK(solid("") == Cells{1, 1, 0, 0});
  CHECK(solid("occupied_thresh: 0.8\n") == Cells{1, 0, 0, 0});
  CHECK(solid("negate: 1\n") == Cells{0, 0, 1, 1});
}

TEST_CASE("a solid block of two by one cells has four edges, each in one piece") {
  Raster raster{{}, 0.5, 4, 3, std::vector<std::uint8_t>(12, 0)};
  raster.solid[1 * 4 + 1] = raster.solid[1 * 4 + 2] = 1;
  const auto edges = edges_of(raster);
  REQUIRE(edges.size() == 4);
  double around = 0.0;
  for (const WallSegment& e : edges) around += distance(e.from, e.to);
  CHECK(around == Approx(3.0));  // 1.0 + 0.5 + 1.0 + 0.5
}

TEST_CASE("MobileSim maps: LINES are walls, DATA only where there are none, carriage returns are no matter") {
  const WallMap lines = load_aria_map(folder().write(
      "a.map", "2D-Map\r\nCairn: Goal 1 2 0 \"\" ICON \"x\"\r\nLINES\r\n-500 0 1500 250\r\nDATA\r\n1 2\r\n"));
  REQUIRE(lines.segments.size() == 1);
  CHECK(lines.segments[0].from == Vec2{-0.5, 0.0});
  CHECK(lines.segments[0].to == Vec2{1.5, 0.25});
  CHECK(lines.discs.empty());
  const WallMap points = load_aria_map(folder().write("b.map", "2D-Map\nDATA\n1000 2000\n3000 4000\n"));
  REQUIRE(points.discs.size() == 2);
  CHECK(points.discs[1].centre == Vec2{3.0, 4.0});
  CHECK(points.discs[1].radius_m == 0.02);
}
