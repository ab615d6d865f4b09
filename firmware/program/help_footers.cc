#include "firmware/program/help_footers.h"

#include <array>
#include <string>

namespace jaywalk {
namespace {

struct Footer {
  const char* command;
  const char* example;
  const char* zero;
  const char* one;
};

constexpr std::array<Footer, 19> kFooters{{
    {"sim", "sim hal/sim/scenarios/crossing.toml --seed 2 --view",
     "the goal was reached, nobody touched or made to turn", "it was not"},
    {"replay", "replay scans.txt odometry.txt --laser-mount 0.1,0,0", "replayed",
     "a recording's commands come out otherwise"},
    {"field", "field hal/sim/maps/map1.yaml --goal 24,24", "the field is certified", "it is not"},
    {"export", "export out/sim", "exported", "-"},
    {"why", "why out/sim 12.5", "told", "-"},
    {"campaign", "campaign deploy/campaigns/first.toml --out out/first", "all runs are finished",
     "it was stopped, or runs crashed or were refused"},
    {"report", "report out/sim", "told", "runs of the campaign are missing"},
    {"bench", "bench --largest 256 --json rows.json", "measured", "-"},
    {"faults", "faults --out out/faults", "every row is ok", "one is not"},
    {"run", "run deploy/config/wheelchair.toml", "ended without a fault", "a fault stopped it"},
    {"check", "check deploy/config/wheelchair.toml", "all is well", "something is not"},
    {"commission", "commission deploy/config/wheelchair.toml", "wired as the file says", "not so"},
    {"calibrate", "calibrate out/sim", "calibrated", "the drive tells too little"},
    {"setup", "setup --answers answers.toml --out robot.toml", "written, and check finds all well",
     "written, and something is not well"},
    {"config", "config --explain laser.rate_hz", "explained", "-"},
    {"goto", "goto 4.0,1.5 1.57", "the run goes", "it refuses"},
    {"stop", "stop --now", "the run stops", "it refuses"},
    {"reset", "reset", "the run may move again", "it refuses"},
    {"status", "status --json", "the run answered", "it refuses"},
}};

std::string text_of(const Footer& footer, const std::string& program) {
  const std::string one = footer.one == std::string("-") ? "" : std::string(", 1: ") + footer.one;
  return "Example:\n  " + program + " " + footer.example + "\nExit code: 0: " + footer.zero + one +
         ", 2: bad input or set-up";
}

}  // namespace

void add_footers(CLI::App& app) {
  const std::string program = app.get_name();
  std::string example;
  for (const Footer& footer : kFooters) {
    const auto has_it = [&footer](const CLI::App* command) { return command->get_name() == footer.command; };
    if (app.get_subcommands(has_it).empty()) continue;
    if (example.empty()) example = footer.example;
    app.get_subcommand(footer.command)->footer(text_of(footer, program));
  }
  app.footer("Example:\n  " + program + " " + example +
             "\nExit code: 0: as asked, 1: not so, 2: bad input or set-up; each command's --help says more");
}

}  // namespace jaywalk
