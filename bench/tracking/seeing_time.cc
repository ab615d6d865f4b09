// How long seeing takes in a crowd: processor time of the one thread, a scan at a time.
// docs/explanation/results.md#time.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <ctime>
#include <memory>

#include "apps/report/distribution.h"
#include "bench/command_line.h"
#include "bench/tracking/crowd.h"
#include "hal/sim/social_walkers.h"

namespace jaywalk::bench {
namespace {
constexpr std::uint32_t kSettled = 150;  // scans until the crowd is known

double thread_ms() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

struct Figures {
  Distribution localizing_ms, tracking_ms, seeing_ms, tracks, moving;
};

Figures measure(std::uint32_t scans) {
  const auto crowd = std::make_unique<Crowd>();
  CrowdWatcher watcher(*crowd);
  auto& [localizer, tracker] = watcher;
  const auto scan = std::make_unique<LaserScan>();
  WheelState wheels;
  Figures figures;
  for (std::uint32_t k = 0; k < kSettled + scans; ++k) {
    crowd->at(k, *scan, wheels);
    const double begun = thread_ms();
    (void)localizer.update(wheels, *scan, {}, tracker.still(), tracker.moving());
    const double placed = thread_ms();
    tracker.update(*scan, localizer.map_from_robot_at_scan(), localizer.twist());
    const double seen = thread_ms();
    if (k < kSettled) continue;
    figures.localizing_ms.add(placed - begun);
    figures.tracking_ms.add(seen - placed);
    figures.seeing_ms.add(seen - begun);
    figures.tracks.add(static_cast<double>(tracker.tracks().size()));
    figures.moving.add(static_cast<double>(tracker.moving().size()));
  }
  return figures;
}

/// Steps of 20 ms of 64 social movers in the same hall: 20 times real time is 1 ms.
Distribution social_steps_ms(std::uint32_t steps) {
  const auto crowd = std::make_unique<Crowd>();
  sim::Scenario scenario;
  scenario.start = crowd->start();
  scenario.social = {{.count = 64, .reaction = sim::Reaction::kMixed}};
  const sim::FreeGrid grid(crowd->walls(), 0.2, scenario.start.position(), {});
  sim::SocialWalkers walkers({scenario, crowd->walls(), grid}, 1, 0, {});
  Distribution took_ms;
  for (std::uint32_t k = 0; k < steps; ++k) {
    const double begun = thread_ms();
    walkers.step(0.02, {crowd->model().footprint, crowd->start()}, {}, {});
    took_ms.add(thread_ms() - begun);
  }
  return took_ms;
}

}  // namespace
}  // namespace jaywalk::bench

int main(int argc, char** argv) {
  using namespace jaywalk::bench;
  std::uint32_t scans = 3000;
  CLI::App app("Times localisation and tracking among 64 walkers, 1,081 beams a scan", "jaywalk_seeing_time");
  app.add_option("--scans", scans, "how many to time")->check(CLI::Range(1, 1000000))->capture_default_str();
  return run(app, argc, argv, [&] {
    const Figures figures = measure(scans);
    print_head("a scan");
    print_row("localisation, ms", figures.localizing_ms);
    print_row("tracking, ms", figures.tracking_ms);
    print_row("both, ms", figures.seeing_ms);
    print_row("a step of 64 social movers, ms", social_steps_ms(scans));
    print_row("tracks", figures.tracks);
    print_row("moving ones", figures.moving);
  });
}
