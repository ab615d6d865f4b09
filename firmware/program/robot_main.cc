// jaywalk_robot: what runs on a board. It leaves the recording; `jaywalk replay` makes tables and pictures of it.
#include "firmware/program/program.h"

int main(int argc, char** argv) {
  using namespace jaywalk;
  CLI::App app{"jaywalk on a robot. Not certified; a navigation laser is not a safety scanner.", "jaywalk_robot"};
  const MakeObserver no_observer = [](auto&&...) { return std::make_unique<TickObserver>(); };
  return run_program(app, argc, argv,
                     [&](CLI::App& to, int& exit_code) { add_robot_commands(to, exit_code, no_observer); });
}
