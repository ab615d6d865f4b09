// Fields, plans and the time to go over cells and poses, byte by byte.
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <memory>

#include "planner/paper/map_field.h"
#include "tests/cuda/acceptance/acceptance.h"

namespace jaywalk::acceptance {
namespace {

constexpr double kCell_m = 0.1;

struct Tally {
  int fields = 0, plans = 0, paths = 0, poses = 0, differ = 0;
  std::string first;  ///< what differed first
  void differs(const std::string& what) {
    if (differ++ == 0) first = what;
    std::fprintf(stderr, "differs: %s\n", what.c_str());
  }
};

template <class T>
bool same(const T* a, const T* b, std::size_t n) {
  return std::memcmp(a, b, n * sizeof(T)) == 0;
}

void check_field(const paper::CellMap& map, const std::string& name, Tally& tally) {
  std::string why;
  const auto cpu = paper::make_cpu_map_field(map), gpu = paper::make_cuda_map_field(map, 0, why);
  if (!gpu) return tally.differs(name + ": " + why);
  CellIndex goal{map.width / 2, map.height / 2};
  if (!cpu->nearest_free(goal, map.width)) return;
  for (const bool cold : {true, false, false}) {
    const paper::FieldQuality a = cold ? cpu->solve_cold(goal) : cpu->solve_warm(goal);
    const paper::FieldQuality b = cold ? gpu->solve_cold(goal) : gpu->solve_warm(goal);
    bool is_same = b.certified && a.joined == b.joined && a.cycles == b.cycles;
    for (std::int32_t c = 0; c < map.width * map.height && is_same; ++c) {
      const float x = cpu->psi(c % map.width, c / map.width), y = gpu->psi(c % map.width, c / map.width);
      is_same = same(&x, &y, 1);
    }
    ++tally.fields;
    if (!is_same) tally.differs(name + (cold ? ", cold" : ", warm"));
  }
}

bool is_same_field(const Planner& cpu, const Planner& gpu, const Plan& a, const Plan& b) {
  const auto psi_a = cpu.view_field().psi, psi_b = gpu.view_field().psi;
  return a.path.size() == b.path.size() && same(a.path.data(), b.path.data(), a.path.size()) &&
         psi_a.size() == psi_b.size() && same(psi_a.data(), psi_b.data(), psi_a.size());
}

bool is_same_time_to_go(const Plan& a, const Plan& b) {
  return a.guide.side == b.guide.side &&
         same(a.guide.to_go_s, b.guide.to_go_s, static_cast<std::size_t>(a.guide.side * a.guide.side)) &&
         a.poses.known == b.poses.known && (a.poses.cost == nullptr) == (b.poses.cost == nullptr) &&
         (a.poses.cost == nullptr || same(a.poses.cost, b.poses.cost, PoseLattice::kPoses));
}

/// `is_paper`: by the paper's planner, else by the robot's.
void check_plans(std::int32_t side, std::uint64_t seed, bool is_paper, const Options& options, Tally& tally) {
  const std::string name = "plan, " + std::to_string(side) + ", seed " + std::to_string(seed);
  Walk walk(side, seed);
  std::string why;
  const auto cpu = is_paper ? paper::make_cpu_paper_planner(walk.config()) : make_cpu_planner(walk.config());
  const auto gpu = is_paper ? paper::make_cuda_paper_planner(walk.config(), 0, why, options.limit)
                            : make_cuda_planner(walk.config(), 0, why, options.limit);
  if (!gpu) return tally.differs(name + ": " + why);
  for (int tick = 0; tick < options.ticks; ++tick) {
    const PlanRequest& request = walk.step(is_paper);
    cpu->submit(request), gpu->submit(request);
    const Plan &a = cpu->collect(), &b = gpu->collect();
    if (b.status == PlanStatus::kBackendFailed) return tally.differs(name + ": " + gpu->failure());
    ++tally.plans;
    tally.paths += a.status == PlanStatus::kOk ? 1 : 0;
    tally.poses += a.poses.known ? 1 : 0;
    const bool is_same =
        a.status == b.status && a.cycles == b.cycles && is_same_time_to_go(a, b) && is_same_field(*cpu, *gpu, a, b);
    if (!is_same) tally.differs(name + ", tick " + std::to_string(tick));
  }
}

}  // namespace

Walk::Walk(std::int32_t side, std::uint64_t seed)
    : side_(side), map_(2 * side, kCell_m, {side * kCell_m / 2.0, side * kCell_m / 2.0}) {
  MapRandom random(seed);
  for (std::int32_t c = 0; c < side * side; ++c) map_.add({c % side, c / side}, -40);
  for (std::int32_t k = 0; k < side / 6; ++k) {
    const std::int32_t i = random.below(side - 4), j = random.below(side - 4), w = 2 + random.below(8);
    for (std::int32_t c = 0; c < w * w; ++c) {
      const CellIndex at{std::min(i + c % w, side - 1), std::min(j + c / w, side - 1)};
      const bool in_corner = (at.i < 18 && at.j < 18) || (at.i > side - 18 && at.j > side - 18);
      if (!in_corner) map_.add(at, EvidenceMap::kMax);
    }
  }
  const auto unit = [&random] { return random.below(1000) / 1000.0; };
  for (std::uint32_t k = 1; k <= 8; ++k) {
    Track& track = tracks_.emplace_back();
    track.id = k;
    track.position_in_map = {side * kCell_m * unit(), side * kCell_m * unit()};
    track.velocity_in_map = {unit() - 0.5, unit() - 0.5};
    track.covariance = {0.001, 0.0005, 0.01};
    track.radius_m = 0.2;
  }
  request.map_from_robot = {0.83, 0.77, 0.6};
  request.goal_in_map = {side * kCell_m - 0.85, side * kCell_m - 0.85};
  request.speed_mps = 0.6;
}

const PlanRequest& Walk::step(bool is_paper) {
  for (Track& track : tracks_) track.position_in_map = track.position_in_map + track.velocity_in_map * (1.0 / 15.0);
  request.map_from_robot.x = request.map_from_robot.x < 1.2 ? request.map_from_robot.x + 0.04 : 0.83;
  request.goal_in_map.y = 0.1 * side_ - (request.map_from_robot.x < 1.0 ? 0.85 : 0.95);
  request.stamp += std::chrono::milliseconds(66);
  request.still = &map_;
  request.moving = tracks_;
  request.poses.is_asked = !is_paper;
  return request;
}

paper::PaperConfig Walk::config() const {
  paper::PaperConfig config;
  config.side_cells = config.max_side_cells = side_;
  config.inflation_m = 0.15;
  config.mover_margin_m = 0.1;
  return config;
}

int parity(const Options& options) {
  Tally tally;
  const auto begin = WallClock::now();
  for (const std::int32_t side : options.sides) {
    // Large maps take their time on the processor: fewer seeds, the same shapes.
    const int seeds = std::min(options.seeds, side <= 256 ? options.seeds : (side <= 512 ? 6 : 2));
    for (int seed = 1; seed <= seeds; ++seed) {
      MapRandom random(static_cast<std::uint64_t>(seed));
      const MapKind kind = kMapKinds[seed % 4];
      check_field(random_map(kind, side, random), std::string(name_of(kind)) + ", " + std::to_string(side), tally);
      for (const bool is_paper : {true, false})
        check_plans(side, static_cast<std::uint64_t>(seed), is_paper, options, tally);
    }
  }
  const bool passed = tally.differ == 0 && tally.fields > 0 && (tally.poses > 0 || options.ticks < 2);
  std::printf(
      "{\"passed\": %s, \"fields\": %d, \"plans\": %d, \"paths\": %d, \"poses\": %d, \"differ\": %d, \"first\": "
      "\"%s\", \"s\": %.1f}\n",
      passed ? "true" : "false", tally.fields, tally.plans, tally.paths, tally.poses, tally.differ, tally.first.c_str(),
      ms_since(begin) / 1e3);
  return passed ? 0 : 1;
}

}  // namespace jaywalk::acceptance
