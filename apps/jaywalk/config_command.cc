#include "apps/jaywalk/config_command.h"

#include <array>
#include <cstdio>
#include <string>

#include "apps/campaign/campaign.h"
#include "firmware/robot/robot_file_keys.h"
#include "hal/robot_model_file.h"
#include "hal/shown_text.h"
#include "hal/sim/scenario.h"
#include "hal/types/errors.h"

namespace jaywalk {
namespace {

struct ConfigOptions {
  bool explain = false, markdown = false;
  std::string key;
};
ConfigOptions options;

/// "drive.can", "timeout_s"; of a section "drive:vesc" as "drive.left_node".
std::string path_of(const SettingKey& key) {
  const std::string table = key.section.substr(0, key.section.find(':'));
  return table.empty() ? key.key : table + "." + key.key;
}

/// " (where kind is vesc)", or nothing.
std::string condition_of(const SettingKey& key) {
  const std::size_t colon = key.section.find(':');
  return colon == std::string::npos ? "" : " (where kind is " + key.section.substr(colon + 1) + ")";
}

/// The last name, the whole path, or its end.
bool names(const std::string& wanted, const SettingKey& key) {
  const std::string path = "." + path_of(key);
  return wanted.empty() || path.ends_with("." + wanted);
}

std::string with_unit(const std::string& text, const SettingKey& key) {
  return key.unit[0] == '\0' ? text : text + " " + key.unit;
}

std::string as_text(const SettingKey& key) {
  return "  " + path_of(key) + condition_of(key) + ": " + key.meaning + "\n      " + with_unit(allowed(key), key) +
         "; default: " + default_of(key) + "\n";
}

std::string as_row(const SettingKey& key) {
  return "| `" + path_of(key) + "`" + condition_of(key) + " | " + key.meaning + " | " + allowed(key) + " | " +
         key.unit + " | " + default_of(key) + " |\n";
}

constexpr const char* kHead =
    "# Settings files\n\nEvery key of every file. Generated: `jaywalk config --explain --markdown "
    ">docs/configuration.md`; a test holds it "
    "against the program.\n`jaywalk config --explain KEY` prints a key's lines. An unknown key is refused with file "
    "and line.\n";

int explain() {
  const std::array<const FileKeys*, 4> files{&robot_file_keys(), &robot_model_keys(), &sim::scenario_keys(),
                                             &campaign::campaign_keys()};
  std::string page = options.markdown ? kHead : "";
  bool found = false;
  for (const FileKeys* file : files) {
    std::string lines;
    for (const SettingKey& key : file->keys)
      if (names(options.key, key)) lines += options.markdown ? as_row(key) : as_text(key);
    if (lines.empty()) continue;
    found = true;
    page += options.markdown ? "\n## " + std::string(file->title) +
                                   "\n\n| key | meaning | allowed | unit | default |\n|---|---|---|---|---|\n"
                             : std::string(file->title) + "\n";
    page += lines;
  }
  if (!found)
    throw StartupError("--explain " + shown(options.key) + ": no file has such a key",
                       "see all of them with jaywalk config --explain");
  std::fputs(page.c_str(), stdout);
  return 0;
}

}  // namespace

void add_config(CLI::App& app, int& exit_code) {
  CLI::App* config = app.add_subcommand("config", "Explain the keys of robot, model, scenario and campaign files");
  config->add_flag("--explain", options.explain, "Print keys with meaning, range, unit and default")->required();
  config->add_option("key", options.key, "One key, or the end of its path: rate_hz, laser.rate_hz (default: all)");
  config->add_flag("--markdown", options.markdown, "As the tables of docs/configuration.md");
  config->callback([&exit_code] { exit_code = explain(); });
}

}  // namespace jaywalk
