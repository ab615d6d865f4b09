// What a drive asked its planner for, asked of every executor: the same bytes.
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <optional>
#include <vector>

#include "planner/paper/paper.h"
#include "planner/paper/paper_planner.h"
#include "tests/firmware/relived.h"
#include "tests/planner/shuffled_executor.h"
#include "tests/support/catch.h"
#if JAYWALK_HAS_CUDA
#include "cuda/paper/cuda_paper.h"
#endif

using namespace jaywalk;

namespace {

/// Plans as `inner` does; some of the requests go to others as well, whose answers are compared with one another.
class ComparingPlanner final : public Planner {
 public:
  ComparingPlanner(std::unique_ptr<Planner> inner, std::vector<std::unique_ptr<Planner>> others, int first, int count)
      : inner_(std::move(inner)), others_(std::move(others)), first_(first), count_(count) {}

  void submit(const PlanRequest& request) noexcept override {
    inner_->submit(request);
    if (const int k = asked_++ - first_; k < 0 || k >= count_) return;
    movers += request.moving.size();
    for (const auto& planner : others_) planner->submit(request);
    const Plan& a = others_[0]->collect();
    for (const auto& planner : others_) alike += is_same(*others_[0], a, *planner, planner->collect()) ? 1 : 0;
  }
  [[nodiscard]] const Plan& collect() noexcept override { return inner_->collect(); }
  [[nodiscard]] FieldView view_field() const override { return inner_->view_field(); }
  [[nodiscard]] const char* backend() const noexcept override { return inner_->backend(); }

  [[nodiscard]] int executors() const { return static_cast<int>(others_.size()); }

  int alike = 0;
  std::size_t movers = 0;

 private:
  static bool is_same(const Planner& one, const Plan& a, const Planner& other, const Plan& b) {
    const auto psi_a = one.view_field().psi, psi_b = other.view_field().psi;
    return a.status == PlanStatus::kOk && b.status == a.status && a.path.size() == b.path.size() &&
           a.cycles == b.cycles && psi_a.size() == psi_b.size() &&
           std::memcmp(a.path.data(), b.path.data(), a.path.size() * sizeof(Vec2)) == 0 &&
           std::memcmp(psi_a.data(), psi_b.data(), psi_a.size_bytes()) == 0;
  }

  std::unique_ptr<Planner> inner_;
  std::vector<std::unique_ptr<Planner>> others_;
  int first_, count_, asked_ = 0;
};

/// Serial first, then whatever else there is.
std::vector<std::unique_ptr<Planner>> every_executor(const paper::PaperConfig& config) {
  std::vector<std::unique_ptr<Planner>> planners;
  planners.push_back(paper::make_cpu_paper_planner(config));
  planners.push_back(std::make_unique<paper::PaperPlanner<test::ShuffledExecutor>>(
      config, std::make_unique<test::ShuffledExecutor>()));
#if JAYWALK_HAS_CUDA
  std::string why_not;
  auto gpu = paper::make_cuda_paper_planner(config, 0, why_not);
  gpu ? planners.push_back(std::move(gpu)) : void(std::printf("not compared with a GPU (%s)\n", why_not.c_str()));
#endif
  return planners;
}

}  // namespace

TEST_CASE("the plans of a recorded drive among walkers have the same bytes on every executor") {
  constexpr int kFirst = 45, kCount = 25;  // at 15 scans a second
  const std::string file = (std::filesystem::temp_directory_path() / "jaywalk_plans.jwr").string();
  {
    SimulatedDrive drive("map1_16", 11, {}, PlanMode::kPaper, file);  // movers are marked in its plans
    drive.drive(5.0);
    REQUIRE(drive.recorder().close());
  }
  std::optional<ComparingPlanner> planner;
  (void)relive(file, [&](const ControlSetup& setup) -> Planner& {
    paper::PaperConfig config{setup.planner(), setup.mover_radius_m()};
    auto inner = paper::make_cpu_paper_planner(config);
    config.max_side_cells = config.side_cells;
    return planner.emplace(std::move(inner), every_executor(config), kFirst, kCount);
  });
  CHECK(planner->alike == kCount * planner->executors());
  CHECK(planner->movers > 0);
}
