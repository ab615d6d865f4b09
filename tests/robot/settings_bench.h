#pragma once
// A folder with one file of each kind, and a parser for each.
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "firmware/robot/robot_file.h"
#include "hal/robot_model_file.h"
#include "hal/sim/scenario.h"
#include "tests/robot/whole_settings.h"

namespace jaywalk {

struct SettingsKind {
  const FileKeys& keys;
  std::function<void(const std::filesystem::path&)> load;
  std::vector<std::string> texts;
};

class SettingsBench {
 public:
  SettingsBench() {
    std::filesystem::create_directories(folder_);
    std::ofstream(folder_ / "posts.txt") << "-8 -8 0.2\n8 -8 0.2\n8 8 0.2\n-8 8 0.2\n";
    std::ofstream(folder_ / "hall.pgm") << "P5\n1 1\n255\n\xFE";
    std::ofstream(folder_ / "hall.yaml") << "image: hall.pgm\nresolution: 0.1\norigin: [0.0, 0.0, 0.0]\nnegate: 0\n"
                                            "occupied_thresh: 0.65\nfree_thresh: 0.196\n";
    std::ofstream(folder_ / "stick.csv") << "t_s,forward,left\n0,1,0\n";
    std::ofstream(folder_ / "rows.csv") << "t_s,id,x_m,y_m\n0,1,0,4\n5,1,1,4\n";
  }
  ~SettingsBench() { std::filesystem::remove_all(folder_); }

  [[nodiscard]] std::vector<SettingsKind> kinds() const {
    std::vector<std::string> scenarios;
    scenarios.push_back(scenario("yaml", "kind = \"straight\"\nforward = 0.9"));
    scenarios.push_back(scenario("aria", "kind = \"to_goal\"\nforward = 0.9"));
    scenarios.push_back(scenario("cylinders", "kind = \"table\"\nfile = \"stick.csv\""));
    return {{robot_file_keys(),
             [](const auto& f) { static_cast<void>(load_robot_file(f)); },
             {kWholeRobots.begin(), kWholeRobots.end()}},
            {robot_model_keys(), [](const auto& f) { static_cast<void>(load_robot_model(f)); }, {kWholeModel}},
            {sim::scenario_keys(), [](const auto& f) { static_cast<void>(sim::load_scenario(f)); }, scenarios}};
  }
  /// The file that holds `text` until the next call.
  [[nodiscard]] std::filesystem::path file(const std::string& text) const {
    std::ofstream(folder_ / "it.toml", std::ios::binary) << text;
    return folder_ / "it.toml";
  }

 private:
  [[nodiscard]] static std::string scenario(const std::string& map, const std::string& stick) {
    std::string text = kWholeScenario;
    text.replace(text.find("MAP"), 3, map + " = \"posts.txt\"" + (map == "yaml" ? "\nknown = true" : ""));
    text.replace(text.find("STICK"), 5, stick);
    return text.replace(text.find("ROWS"), 4, "rows.csv");
  }

  std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("jaywalk_settings_" + std::to_string(::getpid()));
};

}  // namespace jaywalk
