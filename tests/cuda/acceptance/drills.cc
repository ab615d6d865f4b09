// A device that fails under way: every submission is answered, in time, and the device is asked again or is not.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <thread>

#include "planner/cost_to_go/fallback_planner.h"
#include "tests/cuda/acceptance/acceptance.h"

namespace jaywalk::acceptance {
namespace {

constexpr std::int32_t kSide = 128;

class Drill {
 public:
  Drill() {
    std::string why;
    const PlannerConfig config = walk_.config();
    auto gpu = make_cuda_planner(config, 0, why);
    expect(gpu != nullptr, "the device is taken " + why);
    if (gpu) planner_ = std::make_unique<FallbackPlanner>(std::move(gpu), make_cpu_planner(config));
    for (int k = 0; k < 4 && planner_; ++k) expect(plans(), "plans");
    if (planner_) expect(backend() == "cuda", "on " + backend());
    worst_ms_ = 0.0;
  }
  [[nodiscard]] bool plans() {
    const PlanRequest& request = walk_.step(false);
    const auto begin = WallClock::now();
    planner_->submit(request);
    const PlanStatus status = planner_->collect().status;
    worst_ms_ = std::max(worst_ms_, ms_since(begin));
    return status == PlanStatus::kOk;
  }
  void wait_6_s() { walk_.request.stamp += std::chrono::seconds(6); }
  void expect(bool is_so, const std::string& what) {
    passed_ = passed_ && is_so;
    if (!is_so || what != "plans") said_ += what + (is_so ? "; " : " NOT SO; ");
  }
  [[nodiscard]] std::string backend() const { return planner_->backend(); }
  [[nodiscard]] bool is_made() const { return planner_ != nullptr; }
  /// 0 or 1. What a hung kernel would wait for in exit() is left out.
  int report(const std::string& name) {
    planner_.reset();
    std::printf("{\"passed\": %s, \"name\": \"%s\", \"worst_ms\": %.1f, \"said\": \"%s\"}\n",
                passed_ ? "true" : "false", name.c_str(), worst_ms_, said_.c_str());
    std::fflush(nullptr);
    if (has_cuda_left_behind()) std::_Exit(passed_ ? 0 : 1);
    return passed_ ? 0 : 1;
  }

 private:
  Walk walk_{kSide, 4242};
  std::unique_ptr<FallbackPlanner> planner_;
  bool passed_ = true;
  std::string said_;
  double worst_ms_ = 0.0;
};

void answers_in_cpu(Drill& drill, const char* why) {
  for (int k = 0; k < 3; ++k) drill.expect(drill.plans(), "plans");
  drill.expect(drill.backend() == std::string("cpu (cuda: ") + why + ")", drill.backend());
}

void late(Drill& drill) {
  drill.expect(occupy(false), "occupied");
  answers_in_cpu(drill, "a kernel did not end in time");
  std::this_thread::sleep_for(std::chrono::seconds(1));
  drill.wait_6_s();
  drill.expect(drill.plans() && drill.backend() == "cuda", "then on " + drill.backend());
  drill.expect(!has_cuda_left_behind(), "nothing left behind");
}

void hang(Drill& drill) {
  drill.expect(occupy(true), "occupied for good");
  answers_in_cpu(drill, "a kernel did not end in time");
  drill.wait_6_s();
  answers_in_cpu(drill, "a kernel did not end in time");
  drill.expect(has_cuda_left_behind(), "a kernel is left behind");
}

void broken(Drill& drill) {
  drill.expect(break_device(), "broken");
  answers_in_cpu(drill, "the device failed");
  drill.wait_6_s();
  answers_in_cpu(drill, "the device failed");
}

}  // namespace

int drill(const std::string& name) {
  Drill drill;
  std::string why;
  if (!drill.is_made()) return drill.report(name);
  if (name == "late") late(drill);
  if (name == "hang") hang(drill);
  if (name == "broken") broken(drill);
  if (name == "memory") {
    drill.expect(fill_memory(), "memory is full");
    drill.expect(!make_cuda_planner(Walk(512, 1).config(), 0, why), why);
  }
  if (name == "number") drill.expect(!make_cuda_planner(Walk(64, 1).config(), 99, why), why);
  return drill.report(name);
}

int device() {
  std::string why;
  const auto begin = WallClock::now();
  const bool serves = passes_cuda_trial(0, why);
  std::printf("{\"passed\": %s, \"said\": \"%s\", \"trial_ms\": %.0f, %s}\n", serves ? "true" : "false", why.c_str(),
              ms_since(begin), description().c_str());
  return serves ? 0 : 1;
}

}  // namespace jaywalk::acceptance
