// A device that fails under way: the CPU plans from the same submission on, and the process stops and ends.
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <string>
#include <thread>

#include "cuda/cuda_cost_to_go.h"
#include "planner/cost_to_go/fallback_planner.h"
#include "tests/cuda/cuda_rig.h"
#include "tests/planner/same_bytes.h"

using namespace jaywalk;
using namespace jaywalk::test;
using emulated::device;
using emulated::Fault;

namespace {

/// A robot in a room of 6.4 m that asks for a plan at 15 Hz, with times from poses; or for the paper's.
struct Drive {
  explicit Drive(const emulated::Properties& properties = {.guarded = true}, bool is_paper = false) {
    device().power_on(properties);
    planner = std::make_unique<FallbackPlanner>(
        is_paper ? cuda_paper_planner(small_window()) : cuda_planner(small_window()),
        is_paper ? paper::make_cpu_paper_planner(small_window()) : make_cpu_planner(small_window()));
    request.poses.is_asked = true;
  }
  ~Drive() {
    planner.reset();
    device().power_on();
  }
  Drive(const Drive&) = delete;
  Drive& operator=(const Drive&) = delete;

  const Plan& plan() {
    request.stamp += std::chrono::milliseconds(66);
    planner->submit(request);
    return planner->collect();
  }
  /// Plans so much later. What planned it.
  std::string backend_after(Duration pause) {
    request.stamp += pause;
    CHECK(plan().status == PlanStatus::kOk);
    return backend();
  }
  [[nodiscard]] std::string backend() const { return planner->backend(); }

  TestMap room{"room", 64};
  EvidenceMap evidence = evidence_of(room);
  std::unique_ptr<FallbackPlanner> planner;
  PlanRequest request = [this] {
    PlanRequest across_room = across(evidence);
    across_room.stamp = time_from_seconds(100.0);
    return across_room;
  }();
};

/// The emulated device, with one bit wrong in one of its answers.
struct WrongBit final : field::CostSettler {
  enum class In { kNone, kPoses, kCells, kRoom, kShift, kRate };
  explicit WrongBit(In wrong) : in(wrong) {}
  bool is_ready() noexcept override { return settler.is_ready(); }
  const char* failure() const noexcept override { return settler.failure(); }
  double took_ms() const noexcept override { return settler.took_ms(); }
  const char* name() const noexcept override { return settler.name(); }
  bool settle(const field::PoseCosts& poses) noexcept override {
    const bool done = settler.settle(poses);
    if (in == In::kPoses) poses.cost[poses.robot] ^= 1U;
    if (in == In::kRoom) poses.look.room[0] ^= 1U;
    if (in == In::kShift) poses.look.shift[PoseLattice::kPoses - 1] ^= 1;
    if (in == In::kRate) poses.rates.rate[0] ^= 1U;
    return done;
  }
  bool settle(const field::CellCosts& cells) noexcept override {
    const bool done = settler.settle(cells);
    if (in == In::kCells) cells.nodes[cells.robot].cost ^= 1U;
    return done;
  }

  In in;
  CudaCostToGo settler{0, std::chrono::seconds(30), 128};
};

}  // namespace

TEST_CASE("emulated: each way to fail, early, late and between, is answered by the CPU in the same submission") {
  const auto launches = [](bool is_paper) {
    Drive drive({}, is_paper);
    (void)drive.plan();
    if (!is_paper) CHECK(device().counts.waits == 2);  // for cells, for poses
    return static_cast<int>(device().counts.launches);
  };
  const auto points = [](bool is_paper) {
    Drive drive({.guarded = true}, is_paper);
    device().order(Fault::kRefused);
    return drive.plan().path.size();  // the CPU's
  };
  const std::array most{launches(false), launches(true)};
  const std::array path{points(false), points(true)};
  CHECK(most[0] == 6);  // two over cells, four over poses
  CHECK(most[1] > 16);
  for (const auto& [fault, backend] : {std::pair{Fault::kRefused, "cpu (cuda: a launch was refused)"},
                                       std::pair{Fault::kBroken, "cpu (cuda: the device failed)"},
                                       std::pair{Fault::kHangs, "cpu (cuda: a kernel did not end in time)"}}) {
    for (const bool is_paper : {false, true}) {
      for (int launch = 0; launch < most[is_paper ? 1 : 0]; launch += 1 + launch / 2) {
        Drive drive({.guarded = true}, is_paper);
        device().order(fault, launch);
        for (std::uint32_t sequence = 1; sequence <= 3; ++sequence) {
          const Plan& plan = drive.plan();
          CHECK(plan.status == PlanStatus::kOk);
          CHECK(plan.certified);
          CHECK(plan.path.size() == path[is_paper ? 1 : 0]);
          CHECK(plan.sequence == sequence);
          CHECK(drive.backend() == backend);
          CHECK(drive.planner->view_field().psi.size() == 64 * 64);
        }
        CHECK(has_cuda_left_behind() == (fault == Fault::kHangs));
        drive.planner.reset();  // ends the test where it waits for what hangs
      }
    }
  }
}

TEST_CASE("emulated: where nothing changed a plan asks the device for no time from cells") {
  Drive drive;
  drive.request.poses.is_asked = false;
  CHECK(drive.plan().status == PlanStatus::kOk);
  CHECK(drive.planner->collect().sequence == 1);
  const std::int64_t launches = device().counts.launches;
  CHECK(launches > 0);
  device().order(Fault::kBroken);
  CHECK(drive.plan().status == PlanStatus::kOk);  // repaired on the processor
  CHECK(device().counts.launches == launches);
  CHECK(drive.backend() == "cuda");
  drive.request.goal_in_map = {5.0, 0.9};
  CHECK(drive.plan().status == PlanStatus::kOk);
  CHECK(drive.backend() == "cpu (cuda: the device failed)");
}

TEST_CASE("emulated: the device is asked again five seconds after a refused launch, and a minute after three of them") {
  using std::chrono::milliseconds, std::chrono::seconds;
  const std::string refused = "cpu (cuda: a launch was refused)";
  Drive drive;
  device().order(Fault::kRefused);
  CHECK(drive.backend_after(seconds(0)) == refused);
  CHECK(drive.backend_after(milliseconds(4900)) == refused);
  CHECK(drive.backend_after(milliseconds(100)) == "cuda");
  device().order(Fault::kRefused);
  CHECK(drive.backend_after(seconds(0)) == refused);
  CHECK(drive.backend_after(seconds(6)) == "cuda");
  device().order(Fault::kRefused);
  CHECK(drive.backend_after(seconds(0)) == refused);
  CHECK(drive.backend_after(seconds(6)) == refused);  // three within a minute
  CHECK(drive.backend_after(seconds(60)) == "cuda");
}

TEST_CASE("emulated: a kernel that was late and has ended is no reason to leave the device for good") {
  Drive drive;
  (void)drive.plan();
  device().delay(1 << 30);
  (void)drive.plan();
  CHECK(drive.backend() == "cpu (cuda: a kernel did not end in time)");
  device().delay(0);
  CHECK(drive.backend_after(std::chrono::seconds(6)) == "cuda");
  CHECK_FALSE(has_cuda_left_behind());
}

TEST_CASE(
    "emulated: a kernel that hangs, or an error that stays, is not launched upon when the device is asked again") {
  for (const Fault fault : {Fault::kHangs, Fault::kBroken}) {
    Drive drive({.guarded = true});
    device().order(fault);
    (void)drive.plan();
    const std::int64_t launches = device().counts.launches;
    CHECK(drive.backend_after(std::chrono::seconds(6)).substr(0, 4) == "cpu ");
    CHECK(device().counts.launches == launches);
  }
}

TEST_CASE("emulated: a process with a kernel that never ends ends, with the code that it wants") {
  const pid_t child = ::fork();
  if (child == 0) {
    ::alarm(60);  // a limit for the worst case alone
    {
      Drive drive;
      device().order(Fault::kHangs);
      (void)drive.plan();
      drive.planner.reset();
    }
    device().order(Fault::kNone);
    std::_Exit(has_cuda_left_behind() ? 7 : 8);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  CHECK(WIFEXITED(status));
  CHECK(WEXITSTATUS(status) == 7);
}

TEST_CASE(
    "emulated: one wrong bit in a cost of a cell or a pose, in a room, a shift or a rate, and the trial is not "
    "passed") {
  device().power_on();
  using In = WrongBit::In;
  for (const In wrong : {In::kNone, In::kPoses, In::kCells, In::kRoom, In::kShift, In::kRate}) {
    CAPTURE(static_cast<int>(wrong));
    std::string why;
    CHECK(passes_trial(std::make_unique<WrongBit>(wrong), why) == (wrong == In::kNone));
    CHECK(why == (wrong == In::kNone ? "" : "cuda: a trial plan has other bits than the CPU's"));
  }
}

TEST_CASE("emulated: the trial is passed by a device that serves, and by none that is not there or fails, and why") {
  struct Case {
    emulated::Properties properties;
    int number;
    Fault fault;
    const char* why;
  };
  for (const Case& c : {Case{properties_of(3), 0, Fault::kNone, ""},
                        Case{{.devices = 0}, 0, Fault::kNone, "cuda: no device (no CUDA-capable device is detected)"},
                        Case{{.devices = 2}, 2, Fault::kNone, "cuda: no device 2 (2 there, numbered from 0)"},
                        Case{{.bytes = 1 << 20}, 0, Fault::kNone, "cuda: the device does not serve (out of memory)"},
                        Case{{}, 0, Fault::kRefused, "cuda: a trial plan failed (a launch was refused)"},
                        Case{{}, 0, Fault::kBroken, "cuda: a trial plan failed (the device failed)"},
                        Case{{}, 0, Fault::kHangs, "cuda: a trial plan failed (a kernel did not end in time)"}}) {
    device().power_on(c.properties);
    device().order(c.fault);
    std::string why;
    CHECK(passes_cuda_trial(c.number, why) == (*c.why == '\0'));
    CHECK(why == c.why);
  }
  device().power_on();
}

TEST_CASE("emulated: the second device plans, from another thread than the one that made the planner, too") {
  device().power_on({.devices = 2, .guarded = true});
  std::string why;
  const auto gpu = paper::make_cuda_paper_planner(small_window(), 1, why);
  REQUIRE(gpu != nullptr);
  const auto cpu = paper::make_cpu_paper_planner(small_window());
  const EvidenceMap room = evidence_of({"room", 64});
  std::thread([&] { CHECK(check_plan(*cpu, *gpu, across(room))); }).join();
  CHECK(check_plan(*cpu, *gpu, across(room)));
}
