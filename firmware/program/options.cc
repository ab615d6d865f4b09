#include "firmware/program/options.h"

namespace jaywalk {
namespace {

std::string text_of(const Footer& footer, const std::string& program) {
  const std::string one = footer.one == std::string("-") ? "" : std::string(", 1: ") + footer.one;
  return "Example:\n  " + program + " " + footer.example + "\nExit code: 0: " + footer.zero + one +
         ", 2: bad input or set-up, 130: ended by Ctrl-C";
}

}  // namespace

void add_footers(CLI::App& app, std::span<const Footer> footers) {
  const std::string program = app.get_name();
  for (const Footer& footer : footers) app.get_subcommand(footer.command)->footer(text_of(footer, program));
  app.footer("Example:\n  " + program + " " + footers.front().example +
             "\nExit code: 0: as asked, 1: not so, 2: bad input or set-up; each command's --help says more");
}

}  // namespace jaywalk
