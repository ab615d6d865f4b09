#include "tests/firmware/relived.h"

#include <unistd.h>

#include <bit>
#include <cstdint>
#include <cstdio>
#include <filesystem>

#include "apps/rivals/paper_mode.h"
#include "firmware/recording/recorded_hal.h"
#include "tests/support/catch.h"

namespace jaywalk {
namespace {

bool same_bits(double a, double b) { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); }

}  // namespace

Relived relive(const std::string& file) {
  ChosenPlanner chosen;
  return relive(file, [&](const ControlSetup& setup) -> Planner& {
    chosen = make_planner(setup);
    return *chosen.planner;
  });
}

Relived relive(const std::string& file, const std::function<Planner&(const ControlSetup&)>& planner_of) {
  RecordingReader reader(file);
  ControlSetup setup = setup_from_text(reader.setup(), file);
  equip(setup);
  TickRecord recorded;
  RecordedHal devices(recorded);
  Recorder nowhere({});
  ControlLoop loop(setup, devices.hal(setup.model.lasers().size()), planner_of(setup), nowhere);
  Relived relived;
  for (; reader.next(recorded); ++relived.ticks) {
    loop.tick(recorded.now);
    nowhere.drain();
    const WheelCommand& again = devices.commanded();
    const bool same = same_bits(again.left_radps, recorded.command.left_radps) &&
                      same_bits(again.right_radps, recorded.command.right_radps);
    relived.different += same ? 0 : 1;
  }
  std::remove(file.c_str());
  return relived;
}

int different_commands(double seconds, const SimulatedDrive::Edit& edit, PlanMode mode) {
  const std::string file =
      (std::filesystem::temp_directory_path() / ("jaywalk_" + std::to_string(::getpid()) + ".jwr")).string();
  {
    SimulatedDrive drive("map1_16", 7, edit, mode, file);
    drive.drive(seconds);
    REQUIRE(drive.recorder().close());
  }
  const Relived relived = relive(file);
  REQUIRE(relived.ticks == static_cast<int>(seconds * 50.0));
  return relived.different;
}

}  // namespace jaywalk
