#include "apps/report/run_report.h"

#include <array>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>

#include "hal/types/errors.h"
#include "tests/recording/scratch.h"
#include "tests/support/catch.h"
#include "tests/support/text.h"

namespace jaywalk {
namespace {

using Json = nlohmann::json;

/// Two seconds at 50 Hz: 1 m/s to the east past a mover, a scan every fifth tick, one track.
std::string drive(const std::filesystem::path& folder, bool with_truth) {
  RunReport report(folder);
  const auto record = std::make_unique<TickRecord>();
  std::array<Track, 1> tracks;
  tracks[0].id = 9;
  tracks[0].moving = true;
  tracks[0].covariance.pp = 0.0625;
  for (int i = 0; i <= 100; ++i) {
    record->now = Time{Duration{20'000'000LL * i}};
    record->scan.sequence = static_cast<std::uint32_t>(1 + i / 5);
    record->scan.stamp = Time{Duration{100'000'000LL * (i / 5)}};
    record->pose.map_from_robot = {0.02 * i, 0.5, 0};
    record->verdict.reasons = i == 0             ? Reason::kStopZone | Reason::kNoGoal
                              : i / 10 == 4      ? Reason::kMotionMismatch | Reason::kUnwatched
                              : i == 70          ? Reason::kScanStale
                              : i > 90 && i < 95 ? Reason::kEmergencyStop | Reason::kLatched
                                                 : Reason::kNone;
    tracks[0].stamp = tracks[0].last_seen = record->scan.stamp;
    tracks[0].position_in_map = {1, 0.1 * i};
    const std::array<TrueMover, 1> movers{{{4, {1, 2}, {0, -0.4}, 0.25, i == 50}}};
    const TrueState truth{.map_from_robot = {0.02 * i, 0, 0},
                          .twist = {1, 0},
                          .movers = movers,
                          .clearance_m = 2.0 - 0.01 * i,
                          .mover_clearance_m = i == 30 ? 0.75 : 3.0,
                          .contacts = 2,
                          .contacts_caused = 1,
                          .forced_movers = i < 50 ? 0U : 1U,
                          .social = {0.02 * i, 0.01 * i, 0.5, 0.25}};
    RunSample sample{*record, tracks};
    if (with_truth) sample.truth = &truth;
    sample.tick_took = Duration{i == 100 ? 3'000'000 : 1'000'000};
    if (i % 5 == 0) sample.plan_took = {.ms = 0.5, .processor_ms = 0.25, .device_ms = 0.125};
    report.add(sample);
  }
  CHECK(report.driven().size() == 11);
  CHECK(report.mover_trails().size() == (with_truth ? 1 : 0));
  return report.finish({.outcome = "reached",
                        .success = true,
                        .static_shortest_path_m = 1.9,
                        .backend = "cpu",
                        .mode = "full",
                        .seed = 7,
                        .version = "0.1.0"});
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

TEST_CASE("a run leaves its tables with the columns that others rely on") {
  const Scratch scratch;
  drive(scratch.folder() / "out", true);
  const auto robot = lines_of(scratch.read("out/robot.csv"));
  REQUIRE(robot.size() == 102);
  CHECK(robot[0] ==
        "t_s,x_m,y_m,heading_rad,v_mps,w_radps,est_x_m,est_y_m,est_heading_rad,wanted_v_mps,permitted_v_mps,"
        "left_radps,right_radps,reasons");
  CHECK(robot[1] ==
        "0.000000,0.000000,0.000000,0.000000,1.000000,0.000000,0.000000,0.500000,0.000000,0.000000,0.000000,"
        "0.000000,0.000000,stop_zone|no_goal");
  const auto movers = lines_of(scratch.read("out/movers.csv"));
  REQUIRE(movers.size() == 102);
  CHECK(movers[0] == "t_s,id,x_m,y_m,vx_mps,vy_mps,forced");
  CHECK(movers[51] == "1.000000,4,1.000000,2.000000,0.000000,-0.400000,1");
  const auto tracks = lines_of(scratch.read("out/tracks.csv"));
  REQUIRE(tracks.size() == 22);  // 21 scans, one row each
  CHECK(tracks[0] == "t_s,id,x_m,y_m,vx_mps,vy_mps,moving,std_m,radius_m,pedestrian");
  CHECK(tracks[2] == "0.100000,9,1.000000,0.500000,0.000000,0.000000,1,0.250000,0.000000,0");
}

TEST_CASE("the summary has every figure of the run") {
  const Scratch scratch;
  const Json j = Json::parse(drive(scratch.folder(), true));
  CHECK(j == Json::parse(scratch.read("summary.json")));
  const Json expected = Json::parse(R"({"outcome": "reached", "success": true, "static_shortest_path_m": 1.9,
"min_mover_clearance_m": 0.75, "forced_movers": 1, "intimate_s": 2.0, "personal_s": 1.0, "slowed_m": 0.5,
"turned_rad": 0.25, "contacts": 2, "contacts_caused": 1, "accel_max_mps2": 0.0, "jerk_max_mps3": 0.0, "ticks": 101,
"missed_ticks": 0, "not_recorded": [], "seed": 7, "mode": "full", "backend": "cpu", "version": "0.1.0",
"tick_ms/p50": 1.0, "tick_ms/max": 3.0, "plan_ms/p99": 0.5,
"plan_processor_ms/p99": 0.25, "plan_device_ms/max": 0.125})");
  for (const auto& [key, value] : expected.items()) {
    CAPTURE(key);
    CHECK(j.at(Json::json_pointer("/" + key)) == value);
  }
  CHECK(j["faults"] == 2);  // an emergency stop is none
  for (const auto& [key, value] : {std::pair{"path_length_m", 2.0}, {"duration_s", 2.0}, {"min_clearance_m", 1.0}})
    CHECK(j[key].get<double>() == Approx(value));
  CHECK(j["max_turn_deg"].get<double>() == Approx(0.0).margin(1e-9));
  CHECK(j["turn_histogram"].size() == 18);
}

TEST_CASE("what only a world can know is null in a replay") {
  const Scratch scratch;
  const Json j = Json::parse(drive(scratch.folder(), false));
  for (const char* key :
       {"success", "min_clearance_m", "min_mover_clearance_m", "forced_movers", "contacts", "contacts_caused",
        "slowed_m", "accel_max_mps2", "jerk_p99_mps3", "jerk_max_mps3", "mover_rule", "detour_m"}) {
    INFO(key);
    CHECK(j.at(key).is_null());
  }
  CHECK(j["measured_on"] == "estimate");
  CHECK(lines_of(scratch.read("robot.csv"))[2].substr(0, 22) == "0.020000,,,,,,0.020000");
  CHECK(lines_of(scratch.read("movers.csv")).size() == 1);
}

TEST_CASE("without a folder the figures are kept and nothing is written") {
  CHECK(Json::parse(drive("", true))["ticks"] == 101);
}

TEST_CASE("a table that the disk did not take whole stands in the summary by its name") {
  for (const std::string table : {"robot.csv", "movers.csv", "tracks.csv"}) {
    const Scratch scratch;
    std::filesystem::create_symlink("/dev/full", scratch.path(table));
    const Json j = Json::parse(drive(scratch.folder(), true));
    REQUIRE(j["not_recorded"].size() == 1);
    CHECK(holds(j["not_recorded"][0], table + ": the disk takes no more of it: "));
    CHECK(j["ticks"] == 101);
  }
}

TEST_CASE("the granted share is the permitted twist's part along the wished one, a rad/s worth half a m/s") {
  CHECK(GrantedShare::share_of({0.6, 0.0}, {0.3, 0.0}) == Approx(0.5));
  CHECK(GrantedShare::share_of({0.6, 0.4}, {0.6, 0.0}) == Approx(0.9));  // 0.36 of 0.36 + 0.25 * 0.16
  CHECK(GrantedShare::share_of({0.0, 0.5}, {0.1, 0.5}) == 1.0);
  CHECK(GrantedShare::share_of({0.6, 0.0}, {-0.2, 0.0}) == 0.0);
  GrantedShare granted;
  CHECK(std::isnan(granted.mean()));
  const auto record = std::make_unique<TickRecord>();
  record->input.steers = true;
  for (int k = 0; k < 5; ++k) {  // in its middle twice, then granted whole, and half twice
    record->now = Time{Duration{20'000'000LL * k}};
    record->wished = {k < 2 ? 0.0 : 0.6, 0.0};
    record->verdict.permitted = {k < 3 ? 0.6 : 0.3, 0.0};
    granted.add(*record);
  }
  CHECK(granted.mean() == Approx(2.0 / 3.0));  // 1, 1/2, 1/2
  CHECK(granted.steered_s() == Approx(0.08));
}

TEST_CASE("a summary that the disk does not take, and a folder that cannot be made, are refused") {
  const Scratch scratch;
  RunReport report(scratch.folder());
  std::filesystem::create_symlink("/dev/full", scratch.path("summary.json"));
  CHECK_THROWS_AS(report.finish({}), StartupError);
  CHECK_THROWS_AS(RunReport(scratch.folder() / "robot.csv" / "out"), StartupError);
}

TEST_CASE("an earlier run's summary and picture do not outlive the beginning of another") {
  const Scratch scratch;
  const auto files = {"summary.json", "run.png", "run.svg"};
  for (const char* file : files) scratch.write(file, "{}");
  const RunReport report(scratch.folder());
  for (const char* file : files) CHECK_FALSE(std::filesystem::exists(scratch.path(file)));
}

}  // namespace
}  // namespace jaywalk
