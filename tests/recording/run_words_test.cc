#include <cstdio>

#include "apps/report/drive_metrics.h"
#include "firmware/recording/map_files.h"
#include "hal/types/errors.h"
#include "tests/recording/scratch.h"
#include "tests/support/catch.h"
#include "tests/support/text.h"

namespace jaywalk {
namespace {

constexpr const char* kHeader =
    "t_s,x_m,y_m,heading_rad,v_mps,w_radps,est_x_m,est_y_m,est_heading_rad,wanted_v_mps,permitted_v_mps,left_radps,"
    "right_radps,reasons\n";

std::string row(double t_s, double x_m, double wheels_radps, const std::string& reasons) {
  char text[200];
  std::snprintf(text, sizeof text, "%.6f,,,,,,%.6f,0.000000,0.000000,0,%.6f,%.6f,%.6f,%s\n", t_s, x_m,
                0.1 * wheels_radps, wheels_radps, wheels_radps, reasons.c_str());
  return text;
}

TEST_CASE("a run by the stick says for how long, and how much of the wish was granted") {
  const Scratch run;
  run.write("robot.csv", kHeader + row(0.0, 0.0, 5.0, "") + row(1.0, 1.0, 5.0, ""));
  run.write("summary.json", R"({"outcome": "stopped", "duration_s": 9.0, "steered_s": 6.0, "granted_share": 0.875})");
  CHECK(holds(run_words(run.folder()),
              "By the stick 6.0 s, by itself 3.0 s; 88 % of what the stick asked for was granted.\n"));
}

TEST_CASE("a run that a drive's fault ended tells node, code and meaning") {
  const Scratch run;
  run.write("robot.csv", kHeader + row(0.0, 0.0, 5.0, "") + row(1.0, 1.0, 0.0, "drive|latched"));
  run.write("devices.json", R"json({"drive_fault": "node 5: emergency 2310h (continuous over-current)"})json");
  CHECK(run_words(run.folder())
            .ends_with("  drive, once\nIts drives: node 5: emergency 2310h (continuous over-current).\n"));
}

TEST_CASE("a run in words: 4 m in 4 s, 3 s before something in its way, a latched fault for 2 s") {
  const Scratch run;
  std::string table = kHeader;
  double t = 0.0, x = 0.0;
  for (int k = 0; k < 4; ++k) table += row(t++, x++, 5.0, "");
  for (int k = 0; k < 3; ++k) table += row(t++, x, 0.0, "stop_zone");
  table += row(t++, x, 0.0, "scan_stale|latched");
  table += row(t++, x, 0.0, "latched|no_goal");
  table += row(t++, x, 0.0, "no_goal");
  run.write("robot.csv", table);
  run.write("summary.json", R"({"outcome": "fault", "duration_s": 10.0, "loops_at_s": [1.0], "loops_for_s": [2.0],
"detours_at_s": [0.0, 2.5], "detours_for_s": [1.5, 0.5]})");
  // 3.5 s is before the wait; at 8 s a body is nearer than at 5 s.
  run.write("tracks.csv",
            "t_s,id,x_m,y_m,vx_mps,vy_mps,moving,std_m\n1.5,7,2.0,-1.2,0.0,0.6,1,0.1\n3.5,3,4.0,0.1,0.0,0.0,1,0.1\n"
            "5.0,4,4.0,1.5,0.4,0.0,1,0.1\n8.0,5,5.0,0.0,0.0,0.1,1,0.1\n");
  CHECK(
      run_words(run.folder()) ==
      run.folder().string() +
          ": fault after 10.0 s\n"
          "Drove 4.0 m in 4.0 s (1.00 m/s on average); stood 5.0 s.\n"
          "      2.0 s, once: a fault waits for a reset\n"
          "      3.0 s, once: something stands in its way\n"
          "Its longest waits:\n"
          "  at 4.0 s, 4.0, 0.0 m, for 5.0 s: something stands in its way; body 5 was 1.0 m from its middle and stood\n"
          "Full turns within 10 m of way or 60 s:\n"
          "  at 1.0 s, 2.0, 0.0 m, for 2.0 s; body 7 was 1.2 m from its middle and walked\n"
          "Way of which more than a third brought it no nearer:\n"
          "  at 0.0 s, 1.0, 0.0 m, for 1.5 s; body 7 was 1.6 m from its middle and walked\n"
          "  at 2.5 s, 3.0, 0.0 m, for 0.5 s; nobody was near\n"
          "Faults:\n  scan_stale, once\n");
}

TEST_CASE("of many loops the longest are told, and how many there are besides") {
  const Scratch run;
  std::string table = kHeader, at = "0.5", lasted = "0.2";
  for (int k = 0; k < 15; ++k) table += row(k, k, 5.0, "");
  for (int k = 1; k < 12; ++k) at += "," + std::to_string(k) + ".5", lasted += ",0.3";
  run.write("robot.csv", table);
  run.write("summary.json",
            R"({"outcome": "reached", "loops_at_s": [)" + at + R"(], "loops_for_s": [)" + lasted + "]}");
  CHECK(holds(run_words(run.folder()), "nobody was near\n  and 2 shorter\n"));
}

TEST_CASE("a robot that creeps at less than 5 cm/s stands, one that turns on the spot does not") {
  const Scratch run;
  std::string table = kHeader;
  for (int k = 0; k < 4; ++k) table += row(k, 0.04 * k, 0.4, "");
  for (int k = 4; k < 6; ++k) table += std::to_string(k) + ".0,,,,,,0.16,0,0,0,0,-2.0,2.0,\n";
  run.write("robot.csv", table);
  CHECK(holds(run_words(run.folder()), "; stood 4.0 s.\n"));
}

TEST_CASE("a run that was killed is told by its table up to the last whole row") {
  const Scratch run;
  run.write("robot.csv", kHeader + row(0.0, 0.0, 5.0, "") + row(1.0, 1.0, 5.0, "") + "2.000000,,,,,,2.0");
  CHECK(run_words(run.folder()) == run.folder().string() +
                                       ": it left no summary: it was killed, or still runs\n"
                                       "Drove 1.0 m in 1.0 s (1.00 m/s on average); stood 0.0 s.\nFaults: none.\n");
}

TEST_CASE("a folder without a run's table, and a table that is not one, are refused with their place") {
  const Scratch run;
  const auto refusal = [&] { return refusal_of([&] { return run_words(run.folder()); }); };
  CHECK_FALSE(refusal().empty());
  run.write("robot.csv", "t_s,x_m\n");
  CHECK_FALSE(refusal().empty());
  run.write("robot.csv", std::string(kHeader) + "one,two\n");
  CHECK(holds(refusal(), "robot.csv:2: no row"));
}

TEST_CASE("a map is saved as map_server files: rows from the top, the known cells alone") {
  const Scratch out;
  EvidenceMap map(64, 0.1, {0.0, 0.0});
  map.add({2, 3}, EvidenceMap::kMax);  // occupied
  map.add({4, 4}, EvidenceMap::kMin);  // free
  save_map(map, out.folder());
  // Cells 2 to 4 by 3 to 4: unknown, unknown, free; below: occupied, unknown, unknown.
  CHECK(out.read("map.pgm") == std::string("P5\n3 2\n255\n\xCD\xCD\xFE") + '\0' + "\xCD\xCD");
  CHECK(out.read("map.yaml") ==
        "image: map.pgm\nresolution: 0.1\norigin: [0.200000, 0.300000, 0.0]\nmode: trinary\nnegate: 0\n"
        "occupied_thresh: 0.65\nfree_thresh: 0.196\n");
}

TEST_CASE("a map of nothing is one unknown cell, and a folder that is not there is refused") {
  const Scratch out;
  const EvidenceMap map(64, 0.1, {0.0, 0.0});
  save_map(map, out.folder());
  CHECK(out.read("map.pgm") == "P5\n1 1\n255\n\xCD");
  CHECK_THROWS_AS(save_map(map, out.folder() / "nowhere"), StartupError);
}

}  // namespace
}  // namespace jaywalk
