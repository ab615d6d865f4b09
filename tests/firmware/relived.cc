#include "tests/firmware/relived.h"

#include <bit>
#include <cstdint>
#include <cstdio>

#include "apps/rivals/paper_mode.h"
#include "firmware/control_loop.h"
#include "firmware/recording/recorded_hal.h"
#include "firmware/recording/recorder.h"

namespace jaywalk {
namespace {

bool same_bits(double a, double b) { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); }

}  // namespace

Relived relive(const std::string& file) {
  RecordingReader reader(file);
  ControlSetup setup = setup_from_text(reader.setup(), file);
  equip(setup);
  TickRecord recorded;
  RecordedHal devices(recorded);
  const ChosenPlanner planner = make_planner(setup);
  Recorder nowhere({});
  ControlLoop loop(setup, devices.hal(setup.model.lasers().size()), *planner.planner, nowhere);
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

}  // namespace jaywalk
