// Every state of modes, drives, panel and bus that a set of events can lead to, explored on the code that runs.
#include <array>
#include <chrono>
#include <deque>
#include <iostream>
#include <map>
#include <vector>

#include "tests/robot/safety_core.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using tests::SafetyCore;

namespace {

struct Event {
  const char* name;
  void (*happens)(SafetyCore&);
};

constexpr std::array kEvents{
    Event{"goal", [](SafetyCore& c) { c.give_goal(); }},
    Event{"no goal", [](SafetyCore& c) { c.ask("stop"); }},
    Event{"stop in", [](SafetyCore& c) { c.hold_stop(true); }},
    Event{"stop out", [](SafetyCore& c) { c.hold_stop(false); }},
    Event{"stop now", [](SafetyCore& c) { c.ask("stop now"); }},
    Event{"goal and reset as it latches", [](SafetyCore& c) { c.ask_as_it_latches(); }},
    Event{"reset", [](SafetyCore& c) { c.ask("reset"); }},
    Event{"no scans", [](SafetyCore& c) { c.bring_scans(false); }},
    Event{"scans", [](SafetyCore& c) { c.bring_scans(true); }},
    Event{"all pre-operational", [](SafetyCore& c) { c.tell_network(0x80); }},
    Event{"all stopped", [](SafetyCore& c) { c.tell_network(0x02); }},
    Event{"all operational", [](SafetyCore& c) { c.tell_network(0x01); }},
    Event{"right drive's power", [](SafetyCore& c) { c.cut_power(); }},
    Event{"right cable out", [](SafetyCore& c) { c.pull_cable(); }},
    Event{"right cable in", [](SafetyCore& c) { c.plug_cable(); }},
    Event{"left drive breaks", [](SafetyCore& c) { c.break_drive(); }},
    Event{"left drive hangs", [](SafetyCore& c) { c.hang_drive(); }},
    Event{"40 ms", [](SafetyCore&) {}},
    Event{"three seconds", [](SafetyCore& c) { c.ticks(150); }},
};
using Path = std::vector<std::size_t>;

/// Each event, and then so many ticks of 20 ms.
std::unique_ptr<SafetyCore> relive(const Path& path, int ticks_after) {
  auto core = std::make_unique<SafetyCore>();
  for (const std::size_t event : path) {
    kEvents[event].happens(*core);
    core->ticks(ticks_after);
  }
  return core;
}

std::string words_of(const Path& path) {
  std::string words;
  for (const std::size_t event : path) words += std::string(words.empty() ? "" : ", ") + kEvents[event].name;
  return words;
}

/// A state that was reached is left by every event once, by living through its shortest path again: the model checked
/// is the program itself. What that leaves out is other moments than `ticks_after` an event. Prints how many states.
void explore(int ticks_after) {
  const auto began = std::chrono::steady_clock::now();
  std::map<std::string, Path> found{{relive({}, ticks_after)->state(), {}}};
  std::deque<Path> open{{}};
  int steps = 0, driving = 0;
  for (; !open.empty(); open.pop_front()) {
    for (std::size_t event = 0; event < kEvents.size(); ++event) {
      Path path = open.front();
      path.push_back(event);
      const auto core = relive(path, ticks_after);
      ++steps;
      INFO("after: " << words_of(path));
      REQUIRE(core->broken() == "");
      if (found.try_emplace(core->state(), path).second) {
        driving += core->mode() == Mode::kDriving ? 1 : 0;
        open.push_back(path);
      }
    }
  }
  const auto took = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  std::cout << found.size() << " states, " << driving << " of them driving, " << steps << " steps, " << took << " s\n";
  CHECK(found.size() > 100);
  CHECK(driving > 0);
}

}  // namespace

TEST_CASE(
    "no path leads from a fault to motion without reset, zero setpoint and proof, nor to a wheel that turns and is "
    "spoken to") {
  explore(10);
}

// tools/long_tests states
TEST_CASE("the same where events follow one another within 40 ms", "[.states]") { explore(2); }
