#pragma once
// A folder with one file of each kind, and a parser for each.
#include <functional>
#include <string>
#include <vector>

#include "firmware/robot/robot_file.h"
#include "hal/robot_model_file.h"
#include "hal/sim/scenario.h"
#include "tests/recording/scratch.h"
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
    folder_.write("posts.txt", "-8 -8 0.2\n8 -8 0.2\n8 8 0.2\n-8 8 0.2\n");
    folder_.write("hall.pgm", "P5\n1 1\n255\n\xFE");
    folder_.write("hall.yaml",
                  "image: hall.pgm\nresolution: 0.1\norigin: [0.0, 0.0, 0.0]\nnegate: 0\n"
                  "occupied_thresh: 0.65\nfree_thresh: 0.196\n");
    folder_.write("stick.csv", "t_s,forward,left\n0,1,0\n");
    folder_.write("rows.csv", "t_s,id,x_m,y_m\n0,1,0,4\n5,1,1,4\n");
  }

  [[nodiscard]] std::vector<SettingsKind> kinds() const {
    const std::vector<std::string> scenarios{scenario("yaml", "kind = \"straight\"\nforward = 0.9"),
                                             scenario("aria", "kind = \"to_goal\"\nforward = 0.9"),
                                             scenario("cylinders", "kind = \"table\"\nfile = \"stick.csv\"")};
    return {{robot_file_keys(),
             [](const auto& f) { static_cast<void>(load_robot_file(f)); },
             {kWholeRobots.begin(), kWholeRobots.end()}},
            {robot_model_keys(), [](const auto& f) { static_cast<void>(load_robot_model(f)); }, {kWholeModel}},
            {sim::scenario_keys(), [](const auto& f) { static_cast<void>(sim::load_scenario(f)); }, scenarios}};
  }
  /// The file that holds `text` until the next call.
  [[nodiscard]] std::filesystem::path file(const std::string& text) const { return folder_.write("it.toml", text); }

 private:
  [[nodiscard]] static std::string scenario(const std::string& map, const std::string& stick) {
    std::string text = kWholeScenario;
    text.replace(text.find("MAP"), 3, map + " = \"posts.txt\"" + (map == "yaml" ? "\nknown = true" : ""));
    text.replace(text.find("STICK"), 5, stick);
    return text.replace(text.find("ROWS"), 4, "rows.csv");
  }

  Scratch folder_;
};

}  // namespace jaywalk
