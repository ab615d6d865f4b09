#include "firmware/commands/help_footers.h"

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
    {"sim", "jaywalk sim hal/sim/scenarios/crossing.toml --seed 2 --view",
     "the goal was reached, nobody touched or made to turn", "it was not"},
    {"replay", "jaywalk replay scans.txt odometry.txt --laser-mount 0.1,0,0", "replayed",
     "a recording's commands come out otherwise"},
    {"field", "jaywalk field hal/sim/maps/map1.yaml --goal 24,24", "the field is certified", "it is not"},
    {"export", "jaywalk export out/sim", "exported", "-"},
    {"why", "jaywalk why out/sim 12.5", "told", "-"},
    {"campaign", "jaywalk campaign deploy/campaigns/first.toml --out out/first", "all runs are finished",
     "it was stopped, or runs crashed or were refused"},
    {"report", "jaywalk report out/sim", "told", "runs of the campaign are missing"},
    {"bench", "jaywalk bench --largest 256 --json rows.json", "measured", "-"},
    {"faults", "jaywalk faults --out out/faults", "every row is ok", "one is not"},
    {"run", "jaywalk run deploy/config/wheelchair.toml", "ended without a fault", "a fault stopped it"},
    {"check", "jaywalk check deploy/config/wheelchair.toml", "all is well", "something is not"},
    {"commission", "jaywalk commission deploy/config/wheelchair.toml", "wired as the file says", "not so"},
    {"calibrate", "jaywalk calibrate out/sim", "calibrated", "the drive tells too little"},
    {"setup", "jaywalk setup --answers answers.toml --out robot.toml", "written, and check finds all well",
     "written, and something is not well"},
    {"config", "jaywalk config --explain laser.rate_hz", "explained", "-"},
    {"goto", "jaywalk goto 4.0,1.5 1.57", "the run goes", "it refuses"},
    {"stop", "jaywalk stop --now", "the run stops", "it refuses"},
    {"reset", "jaywalk reset", "the run may move again", "it refuses"},
    {"status", "jaywalk status --json", "the run answered", "it refuses"},
}};

std::string text_of(const Footer& footer) {
  const std::string one = footer.one == std::string("-") ? "" : std::string(", 1: ") + footer.one;
  return std::string("Example:\n  ") + footer.example + "\nExit code: 0: " + footer.zero + one +
         ", 2: bad input or set-up";
}

}  // namespace

void add_footers(CLI::App& app) {
  app.footer(
      "Example:\n  jaywalk sim hal/sim/scenarios/crossing.toml\nExit code: 0: as asked, 1: not so, 2: bad input or "
      "set-up; each command's --help says more");
  for (const Footer& footer : kFooters) app.get_subcommand(footer.command)->footer(text_of(footer));
}

}  // namespace jaywalk
