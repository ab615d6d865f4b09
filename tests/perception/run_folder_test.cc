#include "bench/tracking/run_folder.h"

#include <zlib.h>

#include <cmath>

#include "hal/types/errors.h"
#include "tests/recording/scratch.h"
#include "tests/support/catch.h"
#include "tests/support/text.h"

using namespace jaywalk;
using namespace jaywalk::bench;

namespace {

/// The folder of a run.
struct MadeRun : Scratch {
  MadeRun() {
    write("tracks.csv",
          "t_s,id,x_m,y_m,vx_mps,vy_mps,moving,std_m\n"
          "1.000000,4,2.0,0.0,0.5,0.0,1,0.1\n1.000000,5,7.0,0.0,0.0,0.0,0,0.1\n1.066667,4,2.1,0.0,0.5,0.0,1,0.1\n");
    write("robot.csv",
          "t_s,x_m,y_m,heading_rad,est_x_m,est_y_m,est_heading_rad,reasons\n"
          "0.980000,,,,1.0,0.0,0.0,\n1.000000,,,,1.0,1.0,1.5707963267948966,none\n");
  }
  [[nodiscard]] RunFolder run() const { return RunFolder(folder()); }
};

struct Frame {
  double t_s = 0.0;
  std::vector<Target> targets;
};

/// What such labels of the run give.
std::vector<Frame> frames_of(const std::string& labels, const LabelRule& rule) {
  const MadeRun made;
  std::vector<Frame> frames;
  labelled_frames(made.write("people.csv", labels), made.run(), rule,
                  [&](double t_s, const std::vector<Target>& targets) {
                    frames.push_back({t_s, targets});
                  });
  return frames;
}

/// A scan of a corrected CARMEN log at `t`.
std::string laser_line(const std::string& t) { return "FLASER 1 2.0 1 0 0 1 0 0 " + t + " host " + t + "\n"; }

}  // namespace

TEST_CASE("tracks are those of the nearest scan and standing ones can be left out") {
  const RunFolder run = MadeRun().run();
  CHECK(run.tracks_at(1.001, false).size() == 2);
  REQUIRE(run.tracks_at(1.001, true).size() == 1);
  CHECK(run.tracks_at(1.06, true)[0].position_in_map.x == 2.1);
  CHECK(run.tracks_at(1.2, false).empty());
  CHECK(run.poses().empty());  // nobody knows the truth here
}

TEST_CASE("labels in the laser's frame are placed by pose and mount") {
  // Robot at (1, 1) facing +y, laser 0.5 m before it: (2, 0.5) in the laser is (2.5, 0.5) in the robot,
  // and (1 - 0.5, 1 + 2.5) in the map.
  const auto frames = frames_of("t_bag,id,x,y,z\n1.0,3,2.0,0.5,0.0\n", {.robot_from_laser = {0.5, 0.0, 0.0}});
  REQUIRE(frames.size() == 1);
  REQUIRE(frames[0].targets.size() == 1);
  const Target& seen = frames[0].targets[0];
  CHECK(seen.id == 3);
  CHECK(distance(seen.position_in_map, {0.5, 3.5}) < 5e-6);
}

TEST_CASE("labels that were timed when the scan had arrived hold for its stamp") {
  // 1.11 - 0.13 = 0.98 s, when the robot stood at (1, 0) facing +x; at 1 s it has turned.
  const auto frames = frames_of("t_bag,id,x,y,z\n1.11,3,2.0,0.0,0.0\n", {.late_s = 0.13});
  REQUIRE(frames.size() == 1);
  CHECK(frames[0].t_s == Approx(0.98));
  CHECK(distance(frames[0].targets.at(0).position_in_map, {3.0, 0.0}) < 1e-9);
}

TEST_CASE("labels in the map stay where they are") {
  const auto frames =
      frames_of("t_s,id,x_m,y_m\n1.0,3,2.0,0.5\n1.0,4,3.0,0.5\n1.1,3,2.0,0.6\n", {.robot_from_laser = {9.0, 9.0, 9.0}});
  REQUIRE(frames.size() == 2);
  CHECK(frames[0].targets.size() + frames[1].targets.size() == 3);
}

TEST_CASE("finding those who do not walk or have labels only before and after is neither right nor wrong") {
  const std::string labels =
      "t_s,id,x_m,y_m,walks\n1.0,3,2.0,0.5,1\n1.0,4,3.0,0.5,0\n1.1,4,3.0,0.5,1\n1.4,3,2.8,0.5,1\n";
  auto frames = frames_of(labels, {.between_s = 0.39});
  REQUIRE(frames.size() == 3);
  CHECK(frames[0].targets[0].in_view);
  CHECK_FALSE(frames[0].targets[1].in_view);
  CHECK(frames[1].targets.size() == 1);  // 3 is 0.4 s between its labels
  frames = frames_of(labels, {.between_s = 0.41});
  REQUIRE(frames[1].targets.size() == 2);
  const Target& between = frames[1].targets[1];
  CHECK(between.id == 3);
  CHECK(between.position_in_map.x == Approx(2.2));  // a quarter of the way from 2.0 to 2.8
  CHECK_FALSE(between.in_view);
  CHECK(frames[2].targets.size() == 1);  // nobody knows of 4 after 1.1
}

TEST_CASE("tables without the column or with a short row are refused") {
  const MadeRun made;
  CHECK_THROWS_AS(NumberTable(made.path("none.csv")), StartupError);
  CHECK_THROWS_AS(NumberTable(made.write("short.csv", "a,b,c\n1\n")), StartupError);
  const NumberTable table(made.write("good.csv", "a,b\n1,word\n"));
  CHECK(table.column("a")[0] == 1.0);
  CHECK_THROWS_AS(table.column("c"), StartupError);
}

TEST_CASE("what is no number is refused with file and line, and only what nobody knows may be empty") {
  const MadeRun made;
  for (const std::string cell : {"word", "1abc", "nan", "", "inf", "1e300", "0x10"}) {
    const NumberTable table(made.write("bad.csv", "a,b\n1,2\n\n3," + cell + "\n"));
    CHECK(holds(refusal_of([&] { return table.column("b"); }), "bad.csv:4: '" + cell + "' in the column b; "));
    const bool unknown = cell.empty() || cell == "nan";
    CHECK(refusal_of([&] { return table.column_where_known("b"); }).empty() == unknown);
    CHECK(table.column("a")[1] == 3.0);
  }
  const NumberTable truth(made.write("truth.csv", "x_m\nnan\n1\n"));
  CHECK(std::isnan(truth.column_where_known("x_m")[0]));
  for (const std::string name : {"-1", "1.5", "4294967296", "x", ""}) {
    const NumberTable table(made.write("names.csv", "id,x\n7,0\n" + name + ",0\n"));
    CHECK(holds(refusal_of([&] { return table.names("id"); }), "names.csv:3: "));
  }
}

TEST_CASE("a table with carriage returns reads like one without, and a cut .gz is refused") {
  const MadeRun made;
  const NumberTable table(made.write("crlf.csv", "a,b\r\n1, 2.5\r\n"));
  CHECK(table.column("b")[0] == 2.5);
  const std::string gz = made.path("table.csv.gz");
  const gzFile out = gzopen(gz.c_str(), "wb");
  std::string text = "a,b\n";
  for (int k = 0; k < 2000; ++k) text += std::to_string(k * k % 977) + "," + std::to_string(k) + "\n";
  gzwrite(out, text.data(), static_cast<unsigned>(text.size()));
  gzclose(out);
  CHECK(NumberTable(gz).rows() == 2000);
  std::filesystem::resize_file(gz, std::filesystem::file_size(gz) / 2);
  CHECK(holds(refusal_of([&] { return NumberTable(gz); }), "damaged or cut"));
}

TEST_CASE("labels and references most of whose times lie outside the run are another recording's") {
  const MadeRun made;  // 0.98 to 1.00 s, and a second more on either side
  const auto labelled = [&](const std::string& rows) {
    const auto file = made.write("people.csv", "t_s,id,x_m,y_m\n" + rows);
    return refusal_of([&] { labelled_frames(file, made.run(), {}, [](double, const std::vector<Target>&) {}); });
  };
  CHECK(labelled("1.0,3,2,0\n9.0,3,2,0\n").empty());
  CHECK(holds(labelled("1.0,3,2,0\n9.0,3,2,0\n9.5,3,2,0\n"), "1 of its 3 times lie in the run"));
  CHECK(holds(labelled(""), "0 of its 0 times"));
  const auto referred = [&](const std::string& lines) {
    const auto file = made.write("log.carmen", lines);
    return refusal_of([&] { return reference_poses(file, made.run()); });
  };
  CHECK(referred(laser_line("1.0") + laser_line("9.0")).empty());
  CHECK(holds(referred(laser_line("1.0") + laser_line("9.0") + laser_line("9.5")), "1 of its 3"));
  CHECK(holds(referred("FLASER\n"), "log.carmen:1: "));
}
