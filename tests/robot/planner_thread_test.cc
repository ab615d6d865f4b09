#include <atomic>
#include <thread>

#include "firmware/backends.h"
#include "firmware/recording/recorded_hal.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

/// Answers with the request's goal as its path, a cell's evidence, and who stands, when it is let.
class SlowPlanner final : public Planner {
 public:
  explicit SlowPlanner(std::atomic<bool>& may) : may_(may) {}
  void submit(const PlanRequest& request) noexcept override {
    while (!may_) std::this_thread::yield();
    draft_.sequence = ++sequence_;
    draft_.status = PlanStatus::kOk;
    draft_.path.clear();
    static_cast<void>(draft_.path.push_back(request.goal_in_map));
    static_cast<void>(draft_.path.push_back({static_cast<double>(request.still->evidence({0, 0})), 0.0}));
    for (const StandingPedestrian& stander : request.standing)
      static_cast<void>(draft_.path.push_back(stander.position_in_map));
  }
  [[nodiscard]] const Plan& collect() noexcept override { return plan_ = draft_; }
  [[nodiscard]] FieldView view_field() const override { return {}; }
  [[nodiscard]] const char* backend() const noexcept override { return "slow"; }

 private:
  std::atomic<bool>& may_;
  std::uint32_t sequence_ = 0;
  Plan draft_, plan_;
};

PlanRequest request_for(const EvidenceMap& map, double x) {
  PlanRequest request;
  request.goal_in_map = {x, 0.0};
  request.still = &map;
  return request;
}

}  // namespace

static TickObserver nobody;

TEST_CASE("a planner in its own thread keeps nobody waiting and plans with the map and pedestrians as they were") {
  std::atomic<bool> may{false};
  EvidenceMap map(64, 0.1, {});
  map.add({0, 0}, 7);
  PlannerThread planner(std::make_unique<SlowPlanner>(may), map, nobody);
  std::array<StandingPedestrian, 2> standing{{{{1.0, 2.0}, 0.25}, {{3.0, 4.0}, 0.25}}};
  PlanRequest request = request_for(map, 3.0);
  request.standing = standing;
  const AllocationGuard guard;
  planner.submit(request);
  const auto calls = guard.calls();
  CHECK(calls == 0);
  CHECK(planner.is_busy());
  CHECK(planner.collect().status == PlanStatus::kNone);
  map.add({0, 0}, 20);
  standing = {};
  may = true;
  while (planner.is_busy()) std::this_thread::yield();
  CHECK(planner.collect().sequence == 1);
  const Path path = planner.collect().path;
  REQUIRE(path.size() == 4);
  CHECK(path[0] == Vec2{3.0, 0.0});
  CHECK(path[1].x == 7.0);
  CHECK(path[2] == Vec2{1.0, 2.0});
  CHECK(path[3] == Vec2{3.0, 4.0});
  planner.submit(request_for(map, 4.0));
  while (planner.is_busy()) std::this_thread::yield();
  CHECK(planner.collect().sequence == 2);
  CHECK(planner.collect().path[1].x == 27.0);
}

TEST_CASE("a held planner shows each plan when the recording has it, and counts from where a later part begins") {
  for (const std::uint32_t before : {0U, 41U}) {
    CAPTURE(before);
    std::atomic<bool> may{true};
    const EvidenceMap map(64, 0.1, {});
    TickRecord record;
    record.plan_sequence = before;
    HeldPlanner planner(std::make_unique<SlowPlanner>(may), record);
    CHECK(planner.is_busy());  // the recording asked for nothing
    CHECK(planner.collect().status == PlanStatus::kNone);
    record.plan_asked = true;
    CHECK_FALSE(planner.is_busy());
    planner.submit(request_for(map, 3.0));
    record.plan_asked = false;
    CHECK(planner.collect().sequence == 0);  // still under way then
    record.plan_sequence = before + 1;
    CHECK(planner.collect().path[0] == Vec2{3.0, 0.0});
  }
}
