#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>

#include "apps/jaywalk/commands.h"
#include "apps/setup/robot_setup.h"
#include "firmware/program/program.h"
#include "firmware/robot/realtime.h"
#include "firmware/robot/robot_file.h"
#include "hal/types/errors.h"

namespace jaywalk {
namespace {

std::filesystem::path answers_path, out_path = "robot.toml";

void require_new(const std::filesystem::path& out) {
  if (std::filesystem::exists(out))
    throw StartupError(out.string() + ": is there already", "give another --out, or take it away");
}

/// Beside its place first: a file that the program itself would refuse does not come there.
void write_sound(const std::filesystem::path& out, const std::string& text) {
  const std::filesystem::path trial = out.string() + ".new";
  std::ofstream(trial) << text << std::flush;
  if (std::error_code none; std::filesystem::file_size(trial, none) != text.size()) {
    std::filesystem::remove(trial, none);
    throw StartupError(out.string() + ": cannot be written", "see to the folder's rights and the disk's room");
  }
  try {
    static_cast<void>(load_robot_file(trial));
    std::filesystem::rename(trial, out);
  } catch (const StartupError&) {
    std::filesystem::remove(trial);
    throw;
  }
}

/// Beside the robot's file, "robot_model.toml".
std::filesystem::path write_model(RobotDraft& draft) {
  const std::string name = out_path.stem().string() + "_model.toml";
  const std::filesystem::path file = out_path.parent_path() / name;
  require_new(file);
  std::ofstream(file) << draft.model() << std::flush;
  draft.set("", "model", literal(name), "as measured");
  return file;
}

int set_up() {
  require_new(out_path);
  const bool asks = answers_path.empty();
  if (asks && ::isatty(STDIN_FILENO) == 0)
    throw StartupError("setup: nobody is there to be asked", "give --answers FILE: keys of ROBOT.toml that you know");
  const std::filesystem::path kept = out_path.string() + ".answers";
  if (asks && std::filesystem::exists(kept))
    std::printf("Going on with %s, from an earlier setup; remove it to be asked everything.\n", kept.c_str());
  SetupAnswers answers(asks ? std::nullopt : std::optional(answers_path), asks ? &std::cin : nullptr, &std::cout,
                       asks ? kept : "");
  SteadyClock clock;
  std::fputs("Looking for drives, scanners and joysticks; nothing moves.\n", stderr);
  RobotDraft draft = draft_robot(this_machine(clock), answers, clock);
  const std::filesystem::path model = draft.model().empty() ? "" : write_model(draft);
  try {
    write_sound(out_path, draft.text());
  } catch (const StartupError&) {
    if (!model.empty()) std::filesystem::remove(model);
    throw;
  }
  std::filesystem::remove(kept);
  std::printf("%s is written%s.\n", out_path.c_str(), model.empty() ? "" : (", and " + model.string()).c_str());
  RunOptions options;
  options.robot = out_path;
  return check_robot(options);
}

}  // namespace

void add_setup(CLI::App& app, int& exit_code) {
  CLI::App* setup = app.add_subcommand("setup", "Find drives, scanner and joystick, ask the rest, write a ROBOT.toml");
  setup->add_option("--answers", answers_path,
                    "Keys of ROBOT.toml as far as you know them; then nobody is asked (default: asks at the terminal)");
  setup->add_option("--out", out_path, "The file to write; none may be there")->capture_default_str();
  setup->callback([&exit_code] { exit_code = set_up(); });
}

}  // namespace jaywalk
