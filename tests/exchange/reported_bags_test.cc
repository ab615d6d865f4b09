// Recordings whose clocks, orientations, positions and files are other than they say.
#include "apps/formats/logs/log_replay.h"
#include "tests/exchange/made_bags.h"
#include "tests/recording/scratch.h"
#include "tests/support/catch.h"
#include "tests/support/text.h"

namespace jaywalk::exchange {
namespace {

using namespace tests;

constexpr std::int64_t kMilli = 1'000'000, kHour = 3'600'000 * kMilli;

/// made_drive(), its odometry's stamps so much behind; the times of recording stay.
std::vector<MadeMessage> drive_behind(std::int64_t ns) {
  std::vector<MadeMessage> drive = made_drive(false);
  rewrite(drive, "/odom", [&](std::int64_t at, int k) { return odometry_bytes(false, at - ns, 0.1 * k); });
  return drive;
}

bool tells(const sim::RecordedLog& log, const std::string& part) { return holds(log.complaint(), part); }

TEST_CASE("odometry of a clock that is behind counts by the times of recording, and that is told") {
  const sim::RecordedLog plain = read_as_mcap(drive_behind(0));
  for (const std::int64_t behind : {150 * kMilli, 2000 * kMilli, 96 * 24 * kHour, -2000 * kMilli}) {
    const sim::RecordedLog log = read_as_mcap(drive_behind(behind));
    REQUIRE(log.odometry.size() == plain.odometry.size());
    CHECK(log.odometry[4].stamp == plain.odometry[4].stamp);
    CHECK(tells(log, "behind that of the scans, by the times of recording"));
  }
  CHECK_FALSE(tells(plain, "behind"));
  CHECK_FALSE(tells(read_as_mcap(drive_behind(-100 * kMilli)), "behind"));  // a scan is recorded when its sweep is over
}

TEST_CASE("odometry without orientations is left out, told, and the scans are replayed alone") {
  std::vector<MadeMessage> drive = made_drive(false);
  for (const double length : {0.0, 0.4}) {
    rewrite(drive, "/odom",
            [&](std::int64_t ns, int) { return odometry_bytes(false, ns, 0.0, 1.0, "base_link", length); });
    const sim::RecordedLog log = read_as_mcap(drive);
    CHECK(log.odometry.empty());
    CHECK(log.scans.size() == 10);
    CHECK(tells(log, "/odom: left out: its orientations are no quaternions"));
  }
}

TEST_CASE("positions in UTM are taken relative to the first pose, and that is told") {
  std::vector<MadeMessage> drive = made_drive(false);
  rewrite(drive, "/odom", [](std::int64_t ns, int k) { return odometry_bytes(false, ns, 5'400'000.0 + 0.1 * k); });
  const sim::RecordedLog log = read_as_mcap(drive);
  REQUIRE(log.odometry.size() == 10);
  CHECK(log.odometry.front().pose.x == 0.0);
  CHECK(log.odometry.back().pose.x == Approx(0.9));
  CHECK(tells(log, "positions are relative to the first, 5400000.0, 0.0 m"));
}

TEST_CASE("a bag's folder whose list names files that were unpacked or packed since is read") {
  const Scratch scratch;
  write_sqlite(scratch.path("b_0.db3"), made_drive(false), false);
  scratch.write("metadata.yaml", "rosbag2_bagfile_information:\n  relative_file_paths:\n  - b_0.db3.zstd\n");
  CHECK(load_bag(scratch.folder(), {}).scans.size() == 10);
  const Scratch reverse;
  reverse.write("b_0.db3.zstd", packed("zstd", scratch.read("b_0.db3")));
  reverse.write("metadata.yaml", "rosbag2_bagfile_information:\n  relative_file_paths:\n  - b_0.db3\n");
  CHECK(load_bag(reverse.folder(), {}).scans.size() == 10);
}

TEST_CASE("of an MCAP file that was cut the whole messages are replayed, and that is told") {
  const Scratch scratch;
  const std::string first = mcap_of(made_drive(false), "zstd"), bytes = first.substr(0, first.size() - 20);
  const sim::RecordedLog log = load_bag(scratch.write("a.mcap", bytes), {});
  CHECK(log.scans.size() == 10);
  CHECK(tells(log, "the file is cut short here: the 21 whole messages before count"));
}

TEST_CASE("wheels of a log report as often as its odometry does, ten times a second too") {
  const sim::LogReplay replay(read_as_mcap(drive_behind(0)));
  CHECK(replay.drive().times.report_s == Approx(0.1));
  CHECK(replay.drive().times.oldest_report_s() >= 0.25);
}

}  // namespace
}  // namespace jaywalk::exchange
