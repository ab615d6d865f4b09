#include <sys/wait.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <thread>

#include "apps/campaign/campaign.h"
#include "apps/campaign/campaign_folder.h"
#include "tests/recording/scratch.h"
#include "tests/support/catch.h"
#include "tests/support/text.h"

using jaywalk::holds, jaywalk::refusal_of, jaywalk::Scratch;
using namespace jaywalk::campaign;

namespace {

const std::string kSummary =
    R"({"outcome": "OUTCOME", "success": false, "path_length_m": 12.5, "duration_s": 30.0, "contacts": 0,
"heading_error_rad": null, "turn_histogram": [9,1,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,2]})";
// v: forward, 0 (neither), back, forward: two reversals; w: one; two of four rows below 0.05 m/s
const std::string kRobot =
    "t_s,x_m,y_m,v_mps,w_radps,reasons\n0.0,1,1,0.5,0.2,\n1.0,1.5,1,0.01,-0.3,\n2.0,1.5,1,-0.05,-0.2,latched|drive_"
    "fault\n"
    "3.0,1.4,1,0.04,0.05,latched\n";
const std::string kMovers =
    "t_s,id,x_m,y_m,forced\n0.0,1,9,9,0\n0.0,2,3,1,0\n1.0,1,9,9,0\n1.0,2,2.5,1,1\n2.0,1,9,9,1\n3.0,2,2.4,1,0\n";

int exit_of(int code) { return code << 8; }

struct Folder : Scratch {
  explicit Folder(const std::string& outcome) {
    std::string summary = kSummary;
    write("summary.json", summary.replace(summary.find("OUTCOME"), 7, outcome));
    write("robot.csv", kRobot);
    write("movers.csv", kMovers);
  }
  [[nodiscard]] RunResult result(int status = exit_of(1)) const {
    PlannedRun run;
    run.goal = {1.4, 5.0};
    return result_of(run, folder(), status);
  }
};

/// Waits for it.
int status_of(const std::filesystem::path& folder, const std::string& script) {
  RunPool pool("/bin/sh", folder);
  PlannedRun run;
  run.arguments = {"-c", script};
  pool.start(7, run, folder);
  auto ended = pool.ended();
  for (; !ended; ended = pool.ended()) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  CHECK(ended->run == 7);
  return ended->status;
}

}  // namespace

TEST_CASE("a forced mover is told with its moment") {
  const RunResult result = Folder("forced_mover").result();
  CHECK(result.outcome == "forced_mover");
  CHECK(result.arrived());
  CHECK(result.at_s == 1.0);
  CHECK(result.reason == "mover 2 had to turn for the robot, at 0.01 m/s at (1.5, 1.0), 1.00 m apart; 2 movers in all");
}

TEST_CASE("timeouts, collisions and faults are told") {
  const RunResult timeout = Folder("timeout").result();
  CHECK(timeout.at_s == 3.0);  // it still crept
  CHECK(holds(timeout.reason, "time was over 4.0 m from the goal for the robot, at 0.04 m/s"));
  CHECK(holds(Folder("collision").result().reason,
              "something touched the robot, at -0.05 m/s at (1.4, 1.0), mover 2 nearest, 1.00 m off"));
  const RunResult fault = Folder("fault").result();
  CHECK(fault.at_s == 2.0);
  CHECK(holds(fault.reason, "latched|drive_fault"));
}

TEST_CASE("how a passenger is driven is counted") {
  const RunResult result = Folder("timeout").result();
  CHECK(result.figure("speed_reversals") == 2.0);
  CHECK(result.figure("steering_reversals") == 1.0);
  CHECK(result.figure("stood_share") == 0.5);
  CHECK(result.figure("path_length_m") == 12.5);
  CHECK(std::isnan(result.figure("jerk_p99_mps3")));
}

TEST_CASE("hard brakes are counted, and the jerk apart from them") {
  // 0.6 m/s; from 2 s on braked at 1 m/s2 for 0.3 s, from 6 s on slowed at 0.3 m/s2 to rest, at 50 ticks a second.
  std::string table = "t_s,x_m,y_m,v_mps,w_radps,reasons\n";
  for (int k = 0; k < 400; ++k) {
    const double t = 0.02 * k, braked = std::clamp(t - 2.0, 0.0, 0.3), slowed = 0.3 * std::clamp(t - 6.0, 0.0, 1.0);
    char row[80];
    std::snprintf(row, sizeof row, "%.6f,1,1,%.6f,0,\n", t, 0.6 - braked - slowed);
    table += row;
  }
  const Folder folder("timeout");
  folder.write("robot.csv", table);
  const RunResult result = folder.result();
  CHECK(result.figure("hard_brakes") == 1.0);
  // At both ends of the slowing 0.6, 1.2, 1.8, 2.4, 3.0 m/s3 and down again; of about 350 the fourth largest.
  CHECK(result.figure("calm_jerk_p99_mps3") == Approx(2.4).margin(0.01));
}

TEST_CASE("a run that crashed or was refused is a result with its reason") {
  Folder folder("reached");
  folder.write("said.txt", "half a line\njaywalk: " + folder.folder().string() + "/x.toml:3: no; mend it\n");
  const RunResult refused = folder.result(exit_of(2));
  CHECK(refused.outcome == "refused");
  CHECK(refused.reason == "exit code 2: OUT/x.toml:3: no; mend it");
  CHECK_FALSE(refused.ran());
  CHECK(folder.result(SIGSEGV).reason == "ended by signal 11: OUT/x.toml:3: no; mend it");
}

TEST_CASE("a result comes out of its mark as it went in") {
  Folder folder("forced_mover");
  const RunResult result = folder.result();
  const RunResult again = read_result(folder.write("run.json", to_text(result)));
  CHECK(to_text(again) == to_text(result));
  CHECK(again.figure("path_length_m") == 12.5);
  CHECK(again.turns[17] == 2);
  CHECK(holds(refusal_of([&] { return read_result(folder.write("run.json", "{}")); }), "is no run.json"));
}

TEST_CASE("a process that is killed ends alone, and what it said is there") {
  Scratch folder;
  const int status = status_of(folder.folder(), "echo jaywalk: dying; kill -SEGV $$");
  REQUIRE(WIFSIGNALED(status));
  CHECK(result_of({}, folder.folder(), status).reason == "ended by signal 11: dying");
  CHECK(WEXITSTATUS(status_of(folder.folder(), "exit 3")) == 3);
}
