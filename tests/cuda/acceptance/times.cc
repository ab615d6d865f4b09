// What a solution and the time to go take, by the device's events, by the clock, and on the processor.
#include <algorithm>
#include <cstdio>
#include <memory>

#include "planner/paper/map_field.h"
#include "tests/cuda/acceptance/acceptance.h"

namespace jaywalk::acceptance {
namespace {

/// Runs work `repeats` times; prints p50 and p99 of the clock's and the device's microseconds.
template <class Work, class DeviceTime>
void print_times(const char* name, int repeats, const Work& work, const DeviceTime& device_ms) {
  std::vector<double> clock, events;
  work();
  for (int k = 0; k < repeats; ++k) {
    const double before = device_ms();
    const auto begin = WallClock::now();
    work();
    clock.push_back(1e3 * ms_since(begin));
    events.push_back(1e3 * (device_ms() - before));
  }
  const auto at = [](std::vector<double>& us, double share) {
    std::sort(us.begin(), us.end());
    return us[static_cast<std::size_t>(share * static_cast<double>(us.size() - 1))];
  };
  std::printf(", \"%s\": {\"clock_us\": [%.1f, %.1f], \"device_us\": [%.1f, %.1f], \"n\": %d}", name, at(clock, 0.5),
              at(clock, 0.99), at(events, 0.5), at(events, 0.99), repeats);
}

void print_fields(const char* where, paper::MapField& field, std::int32_t side, int repeats) {
  CellIndex goal{side / 2, side / 2};
  field.inflate(3.0F);
  if (!field.nearest_free(goal, side)) return;
  const auto device_ms = [&] { return field.device_ms(); };
  const std::string name = where;
  print_times((name + "_cold").c_str(), repeats, [&] { (void)field.solve_cold(goal); }, device_ms);
  print_times((name + "_warm").c_str(), repeats, [&] { (void)field.solve_warm(goal); }, device_ms);
}

void print_plans(const std::string& name, Planner& planner, std::int32_t side, bool is_paper, int repeats) {
  Walk walk(side, 4242);
  double device_ms = 0.0;  // of all plans
  const auto plan = [&] {
    planner.submit(walk.step(is_paper));
    device_ms += planner.collect().took.device_ms;
  };
  print_times(name.c_str(), repeats, plan, [&] { return device_ms; });
}

}  // namespace

int times(const Options& options) {
  std::printf("{\"passed\": true, \"rows\": [");
  for (std::size_t k = 0; k < options.sides.size(); ++k) {
    const std::int32_t side = options.sides[k];
    MapRandom random(4242);
    const paper::CellMap map = random_map(MapKind::kRooms, side, random);
    const paper::PaperConfig config = Walk(side, 4242).config();
    std::string why;
    const auto gpu = paper::make_cuda_map_field(map, 0, why);
    const auto planner = make_cuda_planner(config, 0, why, options.limit);
    const auto papers = paper::make_cuda_paper_planner(config, 0, why, options.limit);
    if (!gpu || !planner || !papers) return std::printf("], \"why\": \"%s\"}\n", why.c_str()), 1;
    const int repeats = std::max(2, side > 512 ? options.repeats / 5 : options.repeats), few = std::min(repeats, 20);
    std::printf("%s{\"side\": %d", k == 0 ? "" : ", ", side);
    print_fields("gpu", *gpu, side, repeats), print_fields("cpu", *paper::make_cpu_map_field(map), side, few);
    print_plans("gpu_plan", *papers, side, true, repeats);
    print_plans("gpu_time_to_go", *planner, side, false, repeats);
    print_plans("cpu_plan", *paper::make_cpu_paper_planner(config), side, true, few);
    print_plans("cpu_time_to_go", *make_cpu_planner(config), side, false, few);
    std::printf("}");
  }
  std::printf("]}\n");
  return 0;
}

}  // namespace jaywalk::acceptance
