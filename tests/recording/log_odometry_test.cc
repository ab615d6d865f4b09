#include <string>

#include "apps/formats/logs/recorded_log.h"
#include "hal/types/errors.h"
#include "tests/recording/scratch.h"
#include "tests/support/catch.h"
#include "tests/support/text.h"

namespace jaywalk::sim {
namespace {

/// Scans at 100, 100.5 and 103 s, with such odometry.
RecordedLog log_with(const std::string& odometry, const std::string& name = "odom.txt") {
  const Scratch scratch;
  std::string scans;
  for (const std::string t : {"100", "100.5", "103"}) scans += t + " -0.1 0.1 0.03 11.0 3 1.0 2.0 3.0\n";
  return load_scan_odom(scratch.write("scan.txt", scans), scratch.write(name, odometry));
}

}  // namespace

TEST_CASE("odometry of another clock than the scans' is refused, and what is missing of it is told") {
  CHECK_THROWS_AS(log_with("104 0 0 0 0 0\n105 0 0 0 0 0\n"), StartupError);
  CHECK_THROWS_AS(log_with("98 0 0 0 0 0\n99 0 0 0 0 0\n"), StartupError);
  CHECK(log_with("99 0 0 0 0 0\n102.1 0 0 0 0 0\n").complaint().empty());
  const std::string told = log_with("99 0 0 0 0 0\n101 0 0 0 0 0\n").complaint();
  CHECK(holds(told, "odom.txt: nothing of 2.0 of the 3.0 s of scans"));
}

TEST_CASE("odometry that is set anew on its way goes on from where the robot is") {
  const RecordedLog log = log_with(
      "100.1 1 2 0 1 0\n100.2 1.1 2 0 1 0\n100.3 -30 7 1.5707963 1 0\n100.4 -30 7.1 1.5707963 1 0\n"
      "900.5 -30 7.2 1.5707963 1 0\n100.6 -30 7.3 1.5707963 1 0\n");
  REQUIRE(log.odometry.size() == 4);
  CHECK(log.odometry[2].pose.x == Approx(1.2));
  CHECK(log.odometry[3].pose.x == Approx(1.4));
  CHECK(log.odometry[3].pose.y == Approx(2.0));
  CHECK(log.odometry[3].pose.heading == Approx(0.0).margin(1e-6));
  CHECK(holds(log.complaint(), "odom.txt: 1 line left out, the first is line 3: it jumps"));
}

TEST_CASE("odometry of a CSV file is read by the names of its columns, which are told, or by their order") {
  const auto with = [](const std::string& odometry) { return log_with(odometry, "odom.csv"); };
  // A robot.csv of a real run: the world's truth is not known.
  const RecordedLog own = with(
      "t_s,x_m,y_m,heading_rad,est_x_m,est_y_m,est_heading_rad,reasons\n"
      "99.0,,,,1.0,2.0,0.5,\n101.0,,,,1.5,2.0,0.5,stop_zone\n");
  REQUIRE(own.odometry.size() == 2);
  CHECK(own.odometry[1].pose == Pose2{1.5, 2.0, 0.5});
  CHECK(holds(own.complaint(), "of its columns t_s, est_x_m, est_y_m, est_heading_rad are taken"));
  for (const char* text : {"t,x,y,theta\n99,1,2,0.5\n101,1.5,2,0.5\n", "99, 1, 2, 0.5\n101, 1.5, 2, 0.5\n",
                           "99 1 2 0.5\n101 1.5 2 0.5\n", "theta,y,x,time\n0.5,2,1,99\n0.5,2,1.5,101\n"}) {
    const RecordedLog log = with(text);
    REQUIRE(log.odometry.size() == 2);
    CHECK(log.odometry[1].pose == Pose2{1.5, 2.0, 0.5});
    CHECK_FALSE(log.odometry[1].twist);
  }
  CHECK_THROWS_WITH(with("t,x,theta\n99,1,0\n"), Catch::Contains("no column for the position in it; name columns"));
}

}  // namespace jaywalk::sim
