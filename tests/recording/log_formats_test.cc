#include <zlib.h>

#include <cmath>
#include <ctime>
#include <string>

#include "apps/formats/logs/recorded_log.h"
#include "hal/types/errors.h"
#include "tests/recording/recordings.h"
#include "tests/recording/scratch.h"
#include "tests/support/catch.h"
#include "tests/support/text.h"

namespace jaywalk::sim {
namespace {

std::string refusal(const std::string& scan_file) {
  return refusal_of([&] { return load_scan_odom(scan_file); });
}

const std::string kThreeBeams = " -0.1 0.1 0.03 11.0 3 1.0 2.0 3.0\n";  // of a scan, behind its time

constexpr const char* kTwoScans =
    "# t angle_min angle_inc range_min range_max n r\n"
    "100.5 -0.1 0.1 0.03 11.0 3 1.0 nan 2.5\r\n"
    "\n"
    "100.75 -0.1 0.1 0.03 11.0 3 0.0 inf 12\n";

TEST_CASE("scan-odom gives scans with their own angles and stamps") {
  const Scratch scratch;
  const RecordedLog log = load_scan_odom(scratch.write("scan.txt", kTwoScans));
  REQUIRE(log.scans.size() == 2);
  CHECK(log.scans[1].stamp == Time{Duration{100'750'000'000}});
  CHECK(log.scans[0].first_angle_rad == -0.1F);
  CHECK(log.scans[0].range_max_m == 11.0F);
  CHECK(log.range_m[0] == 1.0F);
  CHECK(std::isnan(log.range_m[1]));
  CHECK(std::isinf(log.range_m[4]));
  CHECK(log.odometry.empty());
  CHECK(log.complaint().empty());
  const LaserModel laser = log.laser();
  CHECK(laser.fov_rad == Approx(0.2));
  CHECK(laser.rate_hz == Approx(4.0));  // 0.25 s apart
}

TEST_CASE("one stamp far ahead of its time is left out, and those after it are not") {
  const Scratch scratch;
  const std::string& rest = kThreeBeams;
  for (const std::string ahead : {"100.3", "120", "1100"}) {
    const RecordedLog log = load_scan_odom(
        scratch.write("scan.txt", "100.1" + rest + "100.2" + rest + ahead + rest + "100.4" + rest + "100.5" + rest));
    CHECK(log.scans.size() == (ahead == "100.3" ? 5 : 4));
    CHECK(log.range_m.size() == 3 * log.scans.size());
    CHECK(log.scans.back().stamp == time_from_seconds(100.5));
    CHECK(holds(log.complaint(), "line 3: its time is ahead of those after it") == (ahead != "100.3"));
  }
  const RecordedLog first = load_scan_odom(scratch.write("scan.txt", "900" + rest + "100.2" + rest + "100.3" + rest));
  CHECK(first.scans.front().stamp == time_from_seconds(100.2));
}

TEST_CASE("a plain recording's laser spins once a scan, or ten times a second where scans are fewer") {
  const Scratch scratch;
  const std::string& beams = kThreeBeams;
  // 0.2 rad of a turn: 0.2 / 2 pi of 0.1 s, and of 0.05 s.
  CHECK(to_seconds(load_scan_odom(scratch.write("scan.txt", kTwoScans)).sweep) == Approx(0.00318310));
  const auto fast = scratch.write("fast.txt", "1.00" + beams + "1.05" + beams + "1.10" + beams);
  CHECK(to_seconds(load_scan_odom(fast).sweep) == Approx(0.00159155));
  CHECK(load_scan_odom(scratch.write("motion.txt", "1 0 0 0 3.14 30 3 1 1 1\n2 0 0 0 3.14 30 3 1 1 1\n")).sweep ==
        Duration{0});
}

TEST_CASE("scans with motion increments carry their own odometry") {
  // Turn left a quarter, then twice half a metre ahead: (0, 1). The third line's time stands still:
  // its scan is left out, its half metre counts. Four beams over pi are 45 degrees apart from -90
  // on; a reading of the maximum is no return.
  const Scratch scratch;
  const RecordedLog log = load_scan_odom(scratch.write("log.txt",
                                                       "10.0 9 9 9 3.14159265 30.0 4 1 2 30.0 4\n"
                                                       "10.1 0 0 1.57079633 3.14159265 30.0 4 1 2 3 4\n"
                                                       "10.1 0.5 0 0 3.14159265 30.0 4 1 2 3 4\n"
                                                       "10.2 0.5 0 0 3.14159265 30.0 4 1 2 3 4\n"));
  REQUIRE(log.scans.size() == 3);
  CHECK(log.scans[0].first_angle_rad == Approx(-kPi / 2));
  CHECK(log.scans[0].angle_step_rad == Approx(kPi / 4));
  CHECK(std::isinf(log.range_m[2]));
  CHECK(log.odometry[0].pose == Pose2{});
  CHECK(log.odometry[2].pose.x == Approx(0.0).margin(1e-6));
  CHECK(log.odometry[2].pose.y == Approx(1.0));
  REQUIRE(log.refused.size() == 1);
  CHECK(log.refused[0].place.number == 3);
  CHECK_THROWS_AS(load_scan_odom(scratch.path("log.txt"), scratch.write("odom.txt", "1 0 0 0 0 0\n")), StartupError);
}

TEST_CASE("scans that share their stamps while the robot drives are spaced evenly, and none is left out") {
  // Six scans at 10 s, half a metre apart, and four a second apart: 9 steps over 4 s.
  const Scratch scratch;
  const std::string scan = " 0.5 0 0 3.14159265 30.0 2 1 1\n";
  std::string lines;
  for (const char* said : {"10", "10", "10", "10", "10", "10", "11", "12", "13", "14"}) lines += said + scan;
  const RecordedLog log = load_scan_odom(scratch.write("log.txt", lines));
  REQUIRE(log.scans.size() == 10);
  CHECK(to_seconds(log.scans[3].stamp) == Approx(10.0 + 3 * 4.0 / 9));
  CHECK(to_seconds(log.scans[9].stamp) == Approx(14.0));
  CHECK(log.odometry[9].pose.x == Approx(4.5));
  CHECK(log.refused.empty());
  CHECK(holds(log.complaint(), "drives in 5 lines though their time stands still"));
  CHECK(to_seconds(log.own_time(log.scans[3].stamp)) == Approx(10.0));
  CHECK(to_seconds(log.own_time(log.scans[7].stamp)) == Approx(12.0));
  const Time between = log.scans[7].stamp + (log.scans[8].stamp - log.scans[7].stamp) / 2;
  CHECK(to_seconds(log.own_time(between)) == Approx(12.5));
  CHECK(log.own_time(kNever) == log.own_stamps.front());
  CHECK(log.own_time(Time::max()) == log.own_stamps.back());
}

TEST_CASE("five scans that share one stamp are a tenth of a second apart, and one scan where nothing moves") {
  const Scratch scratch;
  std::string driven, stood;
  for (int k = 0; k < 6; ++k)
    driven += "10 0.5 0 0 3.14159265 30.0 2 1 1\n", stood += "10 0 0 0 3.14159265 30.0 2 1 1\n";
  const RecordedLog log = load_scan_odom(scratch.write("driven.txt", driven));
  REQUIRE(log.scans.size() == 6);
  CHECK(to_seconds(log.scans[5].stamp) == Approx(10.5));
  CHECK(load_scan_odom(scratch.write("stood.txt", stood)).scans.size() == 1);
}

TEST_CASE("lines of a wrong length and lines back in time are left out, counted and told") {
  const Scratch scratch;
  const RecordedLog log = load_scan_odom(scratch.write("scan.txt",
                                                       "1.0 0 0.1 0.1 9 2 1 1\n"
                                                       "1.05 0 0.1 0.1 9 2 1 1\n"
                                                       "1.1 0 0.1 0.1 9 2 1\n"
                                                       "0.9 0 0.1 0.1 9 2 1 1\n"
                                                       "1.2 0 0.1 0.1 9 2 1 1\n"
                                                       "1.2 0 0.1 0.1 9 2 1 1\n"
                                                       "1.3 0 0.1"));
  CHECK(log.scans.size() == 3);
  REQUIRE(log.refused.size() == 2);
  CHECK(holds(log.complaint(), "scan.txt: 2 lines left out, the first is line 3: its number of words"));
  CHECK(holds(log.complaint(), "2 lines left out, the first is line 4: its time does not grow"));
}

TEST_CASE("a line whose n does not count its ranges is left out wherever it stands") {
  const Scratch scratch;
  for (const char* n : {"-2", "x", "2.5", "0", "1e300"}) {
    const std::string good = "1.0 0 0.1 0.1 9 2 5.5 6.5\n2.0 0 0.1 0.1 9 2 5.5 6.5\n";
    const std::string bad = std::string("0.5 0 0.1 0.1 9 ") + n + " 5.5 6.5\n";
    for (const std::string& text : {bad + good, good + bad}) {
      const RecordedLog log = load_scan_odom(scratch.write("scan.txt", text));
      CHECK(log.scans.size() == 2);
      REQUIRE(log.refused.size() == 1);
      CHECK(log.refused[0].cause == "its number of words does not fit");
    }
  }
}

TEST_CASE(
    "what is wrong in any other way is refused with file and line, shortly, and by no byte that a terminal obeys") {
  const Scratch scratch;
  std::string wide = "1.0 0 0.1 0.1 9 3000";
  for (int i = 0; i < 3000; ++i) wide += " 1";
  const std::pair<std::string, std::string> all[] = {
      {"1.0 0 0.1 0.1 9 2 1 1\n1.1 0 0.1 0.1 9 2 1 1x\n", "bad.txt:2: '1x' (word 8) is not a number"},
      {"1.0 0 0.1 0.1 9 2 1 \033[31m\n", "'?[31m' (word 8)"},  // nothing that a terminal obeys
      {"1.0 0 0.1 0.1 9 2 1 " + std::string(4000, 'x'), "'" + std::string(40, 'x') + "...'"},
      {"1.0 0 0 0.1 9 2 1 1\n", "bad.txt:1: no scan in it: beam angles"},
      {"1.0 1e30 0.1 0.1 9 2 1 1\n", "bad.txt:1: no scan in it: beam angles"},
      {"1.0 0 0.1 9 9 2 1 1\n", "bad.txt:1: no scan in it: range limits"},
      {"nan 0 0.1 0 9 2 1 1\n", "bad.txt:1: a time of nan"},
      {"1e300 0 0.1 0 9 2 1 1\n", "bad.txt:1: a time of"},
      {"hello world\n", "bad.txt:1: no scan in it"},
      {"", "bad.txt: no scan in it"},
      {wide, "bad.txt:1: no scan in it: 3000 beams"},
      {std::string(2'000'000, '1'), "over 1 MiB"}};
  for (const auto& [text, said] : all) {
    INFO(said);
    CHECK(holds(refusal(scratch.write("bad.txt", text)), said));
  }
  CHECK(holds(refusal(scratch.path("missing.txt")), "no such file"));
  CHECK(holds(refusal(scratch.folder().string()), "a folder"));
  for (const char* odometry : {"1 2 3\n", "1 1e7 0 0 0 0\n", "1 0 0 0 nan 0\n", "1 0 0 0 0 1e4\n"}) {
    CHECK_THROWS_AS(load_scan_odom(scratch.write("scan.txt", kTwoScans), scratch.write("odom.txt", odometry)),
                    StartupError);
  }
}

TEST_CASE("a line that is odd is left out, counted and told, wherever it stands") {
  const Scratch scratch;
  const std::string good = " 0 0.1 0.1 9 2 5.5 6.5\n";
  const std::pair<const char*, const char*> odd[] = {
      {"10.5 0 0 0.1 9 2 5.5 6.5\n", "beam angles that make no fan"},
      {"10.5 0 nan 0.1 9 2 5.5 6.5\n", "beam angles that make no fan"},
      {"10.5 0 0.1 0 0 2 5.5 6.5\n", "range limits that hold nothing"},
      {"10.5 0 0.1 -0.01 9 2 5.5 6.5\n", "range limits that hold nothing"},
      {"3.5 0 0.1 0.1 9 2 5.5 6.5\n", "its time"},
      {"3617 0 0.1 0.1 9 2 5.5 6.5\n", "its time is over an hour from the others'"}};
  for (const auto& [line, cause] : odd) {
    for (int before = 0; before <= 4; ++before) {
      std::string text;
      for (int k = 0; k <= 4; ++k) text += (k == before ? line : "") + std::to_string(10 + k) + good;
      const RecordedLog log = load_scan_odom(scratch.write("scan.txt", text));
      INFO(text << log.complaint());
      CHECK((log.scans.size() == 5 || (std::string(cause) == "its time" && log.scans.size() == 6)));
      CHECK((log.scans.size() == 6 ||
             log.complaint().find("1 line left out, the first is line " + std::to_string(before + 1) + ": " + cause) !=
                 std::string::npos));
    }
  }
  const RecordedLog log =
      load_scan_odom(scratch.write("scan.txt", kTwoScans),
                     scratch.write("odom.txt",
                                   "100.4 1e256 0 0 0 0\n100.5 0 0 0 nan 0\n100.6 1 2 0.5 0.25 0.125\n"
                                   "100.7 1.1 2 7.0 0.25 0\n"));
  REQUIRE(log.odometry.size() == 2);
  CHECK(log.odometry[0].pose == Pose2{1, 2, 0.5});
  CHECK(log.odometry[0].twist == Twist2{0.25, 0.125});
  CHECK(log.odometry[1].pose.heading == Approx(7.0 - 2 * kPi));
  CHECK(holds(log.complaint(), "line 1: a pose that is none"));
  CHECK(holds(log.complaint(), "line 2: a speed that is none"));
}

TEST_CASE("scans whose number of beams changes get the median one's, each from its own directions") {
  const Scratch scratch;
  // Five beams 0.1 rad apart, then nine 0.05 apart over the same fan, then three 0.2 apart, then two of the first half.
  const RecordedLog log = load_scan_odom(scratch.write("scan.txt",
                                                       "1.0 -0.2 0.1 0.1 9 5 1 2 3 4 5\n"
                                                       "1.1 -0.2 0.05 0.1 9 9 1 8 2 1.5 3 8 4 nan inf\n"
                                                       "1.2 -0.2 0.2 0.1 9 3 1 3 5\n"
                                                       "1.3 -0.2 0.1 0.1 9 2 6 7\n"
                                                       "1.4 -0.2 0.1 0.1 9 5 1 2 3 4 5\n"));
  REQUIRE(log.scans.size() == 5);
  for (const RecordedScan& scan : log.scans) CHECK(scan.beams == 5);
  REQUIRE(log.range_m.size() == 25);
  const std::vector<float> fine(log.range_m.begin() + 5, log.range_m.begin() + 10);
  CHECK(fine[0] == 1.0F);
  CHECK(std::min(fine[1], fine[2]) == 1.5F);  // the thin thing at -0.05 rad is on one of its neighbours
  CHECK(fine[3] == 4.0F);
  CHECK(std::isinf(fine[4]));
  CHECK(log.range_m[10] == 1.0F);
  CHECK(log.range_m[12] == 3.0F);
  CHECK((log.range_m[11] == 1.0F || log.range_m[11] == 3.0F));  // no beam of its own: one beside it
  CHECK(log.range_m[15] == 6.0F);
  CHECK(log.range_m[16] == 7.0F);
  CHECK(std::isnan(log.range_m[17]));
  CHECK(holds(log.complaint(), "scans of 2 to 9 beams, each read as 5"));
}

TEST_CASE("a range of a kilometre is nothing, whatever the limits say") {
  const Scratch scratch;
  const RecordedLog log = load_scan_odom(scratch.write("far.txt", "1.0 0 0.1 0 inf 2 999 1e30\n"));
  CHECK(log.scans[0].range_max_m == 1000.0F);
  CHECK(log.range_m[0] == 999.0F);
  CHECK(std::isinf(log.range_m[1]));
}

TEST_CASE("a compressed recording reads like a plain one, and a cut one is refused") {
  const Scratch scratch;
  const std::string gz = scratch.path("scan.txt.gz");
  gzFile out = gzopen(gz.c_str(), "wb");
  std::string many;
  for (int i = 1; i < 200; ++i) many += std::to_string(i) + ".5 0 0.1 0.1 9 2 1 " + std::to_string(i % 7) + "\n";
  gzwrite(out, many.data(), static_cast<unsigned>(many.size()));
  gzclose(out);
  CHECK(load_scan_odom(gz).scans.size() == 199);
  const std::string bytes = scratch.read("scan.txt.gz");
  CHECK(holds(refusal(scratch.write("cut.gz", bytes.substr(0, bytes.size() / 2))), "damaged or cut"));
}

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr double kLoadLimitS = 30.0;  // what is measured then is the sanitizer
#else
constexpr double kLoadLimitS = 2.0;
#endif

TEST_CASE("the Freiburg log has 4791 scans and loads within two seconds") {
  const auto file = recording("carmen/freiburg-079-corrected.log.gz");
  if (!file) return;
  const std::clock_t before = std::clock();  // processor time: the machine may have other work
  const RecordedLog log = load_carmen(*file);
  const double took = static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC;
  CHECK(log.scans.size() == 4791);
  CHECK(log.scans[0].beams == 360);
  CHECK(log.laser().rate_hz == Approx(4.5).epsilon(0.1));
  CHECK(took < kLoadLimitS);
}

TEST_CASE("the Intel logs load in both formats") {
  const auto carmen = recording("carmen/intel-corrected.log.gz");
  if (!carmen) return;
  CHECK(load_carmen(*carmen).scans.size() == 906);  // of 910, 4 of which go back in time
  const auto motion = recording("intel/scans_odom.txt.gz");
  if (!motion) return;
  const RecordedLog log = load_scan_odom(*motion);
  CHECK(log.scans.size() == 2726);  // 241 stamps stand still, in 204 of them the robot drives
  CHECK(holds(log.complaint(), "drives in 204 lines"));
  CHECK(log.scans[0].beams == 180);
  double way = 0.0;
  for (std::size_t i = 1; i < log.odometry.size(); ++i) {
    way += distance(log.odometry[i - 1].pose.position(), log.odometry[i].pose.position());
  }
  CHECK(way == Approx(506).epsilon(0.02));  // metres, as the recording's own notes say
}

}  // namespace
}  // namespace jaywalk::sim
