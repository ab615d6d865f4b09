#include <cmath>
#include <string>

#include "apps/formats/logs/recorded_log.h"
#include "hal/types/errors.h"
#include "tests/recording/scratch.h"
#include "tests/support/catch.h"
#include "tests/support/text.h"

namespace jaywalk::sim {
namespace {

TEST_CASE("CARMEN beams of 180 and 181 are one degree apart and begin at the right") {
  const double degree = kPi / 180;
  CHECK(carmen_fan(180, kPi).first_rad == Approx(-90 * degree));
  CHECK(carmen_fan(180, kPi).step_rad == Approx(degree));
  CHECK(carmen_fan(181, kPi).step_rad == Approx(degree));
  CHECK(carmen_fan(360, kPi).step_rad == Approx(degree / 2));
}

TEST_CASE(
    "where scans lie beside what the ODOM lines say, those are of another frame and left out, an arc is not beside") {
  const Scratch scratch;
  // Half a metre a scan straight ahead, an ODOM line half way; from the 18th scan on each is `beside_m` off, to the
  // left.
  const auto log_with = [&](double beside_m, int from) {
    std::string text;
    for (int k = 1; k <= 20; ++k) {
      const std::string x = std::to_string(0.5 * k), half = std::to_string(0.5 * k - 0.25), t = std::to_string(k);
      const std::string y = std::to_string(k >= from ? beside_m * (k - from + 1) : 0.0);
      const std::string before = std::to_string(k > from ? beside_m * (k - from) : 0.0);
      text += "ODOM " + half + " " + before + " 0 0 0 0 " + std::to_string(k - 0.5) + " host 1\n";
      text += "FLASER 2 1 1 " + x + " " + y + " 0 " + x + " " + y + " 0 " + t + " host " + t + "\n";
    }
    text += "ODOM 0 0 0 0 0 0 0.5 host 1\n";  // back in time
    const RecordedLog log = load_carmen(scratch.write("beside.carmen", text));
    const bool all_left_out = holds(log.complaint(), "all ODOM lines are left out");
    const bool one = holds(log.complaint(), "1 line left out, the first is line 41: an ODOM line");
    CHECK(all_left_out != one);
    CHECK(all_left_out == (log.odometry.size() == 20));
    return log.odometry.size();
  };
  CHECK(log_with(0.03, 18) == 20);  // three of 20 scans
  CHECK(log_with(0.03, 19) == 40);  // two: one in ten
  CHECK(log_with(0.005, 1) == 40);  // no more than wheels may slip
  // A quarter circle of 1 m radius in one step: (1, 1, 90 degrees) lies on its mean heading.
  const std::string arc = "ODOM 0 0 0 0 0 0 1 host 1\nFLASER 2 1 1 1 1 1.5707963 1 1 1.5707963 2 host 2\n";
  CHECK(load_carmen(scratch.write("arc.carmen", arc)).odometry.size() == 2);
}

TEST_CASE("CARMEN lines become scans and odometry, the FLASER pose before ODOM") {
  // The ODOM line of 2.0 is contradicted by the FLASER line of 2.0, the one of time 0 goes back.
  const Scratch scratch;
  const RecordedLog log = load_carmen(scratch.write("log.carmen",
                                                    "# comment\n"
                                                    "PARAM robot_length 0.47 1 merci 1\n"
                                                    "ODOM 0 0 0 0 0 0 1.5 host 1.5\n"
                                                    "ODOM 5 5 0 0 0 0 2.0 host 2.0\n"
                                                    "FLASER 4 1.0 81.91 50 3 9 9 9 1 0.5 0.25 2.0 host 2.0\n"
                                                    "ODOM 1 0.5 0.25 0 0 0 0 host 0\n"
                                                    "ODOM 2 0.5 0.25 0 0 0 2.5 host 2.5\n"));
  REQUIRE(log.scans.size() == 1);
  CHECK(log.range_m == std::vector<float>{1.0F, HUGE_VALF, HUGE_VALF, 3.0F});
  REQUIRE(log.odometry.size() == 3);
  CHECK(log.odometry[1].pose == Pose2{1, 0.5, 0.25});
  CHECK(log.odometry[1].stamp == time_from_seconds(2.0));
  REQUIRE(log.refused.size() == 1);
  CHECK(log.refused[0].place.number == 6);
}

TEST_CASE("CARMEN's newer laser messages say their own beams, and ROBOTLASER1 where the laser is") {
  const Scratch scratch;
  const std::string beams = " 0 -0.5 1.0 0.5 20.0 0.01 0 3 1.5 20.0 2.5 ";
  const std::string robot = "ROBOTLASER1" + beams + "2 7 7 1.3 2 0 1 2 0 0.5 0 0.3 0.3 1 ";
  const std::string raw = "RAWLASER1" + beams + "0 ";
  const std::string text = "ODOM 0.5 2 0 0 0 0 9.9 host 1\n" + robot + "10.0 host 1\n" + raw + "10.0 host 1\n" +
                           "FLASER 2 1 1 1 2 0 1 2 0 10.0 host 1\n" + robot + "10.2 host 1\n";
  const RecordedLog log = load_carmen(scratch.write("new.log", text));
  REQUIRE(log.scans.size() == 2);
  CHECK(log.scans[1].beams == 3);
  CHECK(log.scans[0].first_angle_rad == -0.5F);
  CHECK(log.scans[0].angle_step_rad == 0.5F);
  CHECK(log.range_m == std::vector<float>{1.5F, HUGE_VALF, 2.5F, 1.5F, HUGE_VALF, 2.5F});  // 20 m: its longest
  CHECK(log.robot_from_laser.x == Approx(0.3));
  REQUIRE(log.odometry.size() == 3);
  CHECK(log.odometry[1].pose == Pose2{1, 2, 0});
  const RecordedLog turned = load_carmen(scratch.write("new.log", text), {0.0, 0.0, 1.0});
  CHECK(turned.robot_from_laser == Pose2{0.0, 0.0, 1.0});

  const RecordedLog bare = load_carmen(scratch.write(
      "raw.log", "ODOM 0.5 2 0 0 0 0 9.9 host 1\n" + raw + "10.0 host 1\n" + raw + "10.1 host 1\nRAWLASER1 3\n"));
  CHECK(bare.scans.size() == 2);
  CHECK(bare.odometry.size() == 1);
  CHECK(holds(bare.complaint(), "line 4: its number of words does not fit"));
}

TEST_CASE("a CARMEN log without scans, or with damaged ones, is refused") {
  const Scratch scratch;
  for (const char* text : {"ODOM 0 0 0 0 0 0 1.5 host 1.5\n", "FLASER 2 1 1 0 0 0 0 x 0 2.0 host 2.0\n",
                           "FLASER 0 0 0 0 0 0 0 2.0 host 2.0\n", "FLASER\n"})
    CHECK_THROWS_AS(load_carmen(scratch.write("a", text)), StartupError);
}

}  // namespace
}  // namespace jaywalk::sim
