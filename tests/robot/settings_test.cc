// The tables of keys and the parsers that use them; files with mistakes of all kinds.
#include <cstdlib>
#include <functional>
#include <random>
#include <set>
#include <stdexcept>

#include "firmware/robot/robot_file.h"
#include "hal/robot_model_file.h"
#include "hal/sim/scenario.h"
#include "hal/toml_file.h"
#include "hal/types/errors.h"
#include "planner/motion/robot_body.h"
#include "tests/recording/scratch.h"
#include "tests/robot/whole_settings.h"
#include "tests/support/catch.h"
#include "tests/support/text.h"

using namespace jaywalk;

namespace {

struct SettingsKind {
  const FileKeys& keys;
  std::function<void(const std::filesystem::path&)> load;
  std::vector<std::string> texts;
};

/// A folder with what files of settings name, and a parser for each kind of them.
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

  [[nodiscard]] static std::vector<SettingsKind> kinds() {
    return {{robot_file_keys(),
             [](const auto& f) { static_cast<void>(load_robot_file(f)); },
             {kWholeRobots.begin(), kWholeRobots.end()}},
            {robot_model_keys(), [](const auto& f) { static_cast<void>(load_robot_model(f)); }, {kWholeModel}},
            {sim::scenario_keys(), [](const auto& f) { static_cast<void>(sim::load_scenario(f)); }, whole_scenarios()}};
  }
  /// The file that holds `text` until the next call.
  [[nodiscard]] std::filesystem::path file(const std::string& text) const { return folder_.write("it.toml", text); }

 private:
  Scratch folder_;
};

/// Adds "section.key" of all that `table` holds; where it has a kind, as "section:kind.key" too.
void collect(const toml::value& table, const std::string& section, std::set<std::string>& keys) {
  const bool has_kind = table.contains("kind");
  for (const auto& [key, value] : table.as_table()) {
    keys.insert(section + "." + key);
    if (has_kind) keys.insert(section + ":" + toml::get<std::string>(table.at("kind")) + "." + key);
    const std::string below = section.empty() ? key : section + "." + key;
    if (value.is_table()) collect(value, below, keys);
    if (!value.is_array()) continue;
    for (const toml::value& item : value.as_array())
      if (item.is_table()) collect(item, below, keys);
  }
}

std::vector<std::string> all_pieces() {
  std::istringstream list(
      "nan|inf|-1|1e308|-9223372036854775808|99999999999999999999|\"\"|[]|[[]]|{}|true|1979-05-27|\"p3dx\"|[drive]\n|"
      "[[movers]]\n|=|.|#|\"|'''|\n||\xff");
  std::vector<std::string> pieces;
  for (std::string piece; std::getline(list, piece, '|');) pieces.push_back(piece);
  return pieces;
}

const std::vector<std::string> kPieces = all_pieces();

class Mutator {
 public:
  explicit Mutator(std::uint32_t seed) : random_(seed) {}

  [[nodiscard]] std::string mutated(std::string text) {
    for (std::size_t k = 1 + below(4); k > 0; --k) mutate(text);
    return text;
  }
  std::size_t below(std::size_t n) { return n == 0 ? 0 : random_() % n; }

 private:
  void mutate(std::string& text) {
    const std::size_t at = below(text.size()), most = text.size() - at;
    switch (below(5)) {
      case 0:
        if (!text.empty()) text[at] = static_cast<char>(random_());
        return;
      case 1: text.erase(at, below(std::min<std::size_t>(most, 30))); return;
      case 2: text.insert(at, kPieces[below(kPieces.size())]); return;
      case 3: replace_value(text, at); return;
      default: text.insert(below(text.size()), text.substr(at, below(std::min<std::size_t>(most, 60))));
    }
  }
  /// What stands behind the next equals sign.
  void replace_value(std::string& text, std::size_t at) {
    const std::size_t equals = text.find("= ", at);
    if (equals == std::string::npos) return;
    const std::size_t end = std::min(text.find('\n', equals), text.size());
    text.replace(equals + 2, end - equals - 2, kPieces[below(kPieces.size())]);
  }

  std::mt19937 random_;
};

}  // namespace

TEST_CASE("every key of the tables is taken by its parser") {
  const SettingsBench bench;
  for (const SettingsKind& kind : bench.kinds()) {
    std::set<std::string> taken;
    for (const std::string& text : kind.texts) {
      const auto file = bench.file(text);
      REQUIRE_NOTHROW(kind.load(file));  // it refuses what it does not take
      collect(toml::parse(file.string()), "", taken);
    }
    for (const SettingKey& key : kind.keys.keys) {
      CAPTURE(kind.keys.title, key.section, key.key);
      CHECK(taken.count(key.section + "." + key.key) == 1);
    }
  }
}

TEST_CASE("a parser that asks for a key which is in no table is a mistake of the program's") {
  const SettingsBench bench;
  const auto path = bench.file("colour = 1.0\n");
  const TomlFile file(path, robot_file_keys());
  TomlTable root = file.root();
  CHECK_THROWS_AS(root.number("colour"), std::logic_error);
  CHECK_THROWS_AS(root.has("colour"), std::logic_error);
}

TEST_CASE("no key is told twice, and every one has a meaning") {
  const SettingsBench bench;
  for (const SettingsKind& kind : bench.kinds()) {
    std::set<std::string> seen;
    for (const SettingKey& key : kind.keys.keys) {
      CAPTURE(kind.keys.title, key.section, key.key);
      CHECK(seen.insert(key.section + "." + key.key).second);
      CHECK(std::string(key.meaning) != "");
      CHECK((key.kind == KeyKind::kChoice) == !key.choices.empty());
      const bool has_range = key.kind == KeyKind::kNumber || key.kind == KeyKind::kInteger;
      CHECK(has_range == (key.range.low < key.range.high));
    }
  }
}

TEST_CASE("the tables' ranges and defaults are those that hold") {
  const SettingsBench bench;
  const auto text = [](const std::string& more) {
    return more +
           "\nmodel = \"p3dx\"\n[laser]\nkind = \"hokuyo\"\nhost = \"h\"\n[drive]\nkind = \"odrive\"\ncan = \"can0\"\n"
           "motor_turns_per_wheel_turn = 1.0\n";
  };
  const SettingKey& rate = robot_file_keys().find("", "rate_hz");
  CHECK(load_robot_file(bench.file(text(""))).setup.rate_hz == std::get<double>(rate.otherwise));
  CHECK_NOTHROW(load_robot_file(bench.file(text("rate_hz = " + std::to_string(rate.range.high)))));
  CHECK_THROWS_AS(load_robot_file(bench.file(text("rate_hz = " + std::to_string(rate.range.high + 0.1)))),
                  StartupError);
  CHECK(allowed(rate) == "20 to 200");
  CHECK(default_of(rate) == "50");
}

TEST_CASE("a text of several lines is refused with its line") {
  const SettingsBench bench;
  for (const std::string quotes : {"'''", "\"\"\""}) {
    const auto file = bench.file("model = \"p3dx\"\ncontrol_socket = " + quotes + "\n" + quotes + "\n");
    CHECK_THROWS_WITH(load_robot_file(file),
                      Catch::Contains("it.toml:2: three quotes begin a text of several lines; "));
  }
}

TEST_CASE("the example with two scanners at its corners looks all round") {
  const RobotModel model = load_robot_file(std::string(JAYWALK_EXAMPLES) + "/two-scanners.toml").setup.model;
  CHECK(model.lasers().size() == 2);
  CHECK(scanner_name(model, 0) == "front");
  CHECK(scanner_name(model, 1) == "rear");
  CHECK(motion::BlindRim(model.footprint, model.lasers()).points() == 0);
  CHECK(motion::BlindRim(model.footprint, model.laser).points() > 0);
}

TEST_CASE("the example robots load") {
  for (const char* name : {"pioneer-p3dx", "pioneer-p3dx-arcos", "cia402-base", "wheelchair", "two-scanners",
                           "turtlebot4", "jackal", "ros2-control-base"}) {
    CAPTURE(name);
    const RobotFile robot = load_robot_file(std::string(JAYWALK_EXAMPLES) + "/" + name + ".toml");
    CHECK(robot.setup.model.limits.max_speed_mps <= 0.6);
    CHECK(robot.realtime.required);
  }
}

// By one line: never a crash, never another exception.
TEST_CASE("mutated settings files are refused or loaded") {
  const char* wanted = std::getenv("JAYWALK_MUTATIONS");
  const int files = wanted != nullptr ? std::atoi(wanted) : 3000;
  const SettingsBench bench;
  const auto kinds = bench.kinds();
  Mutator mutator(36);
  int refusals = 0;
  for (int k = 0; k < files; ++k) {
    const SettingsKind& kind = kinds[mutator.below(kinds.size())];
    const std::string text = mutator.mutated(kind.texts[mutator.below(kind.texts.size())]);
    CAPTURE(k, text);
    const std::string said = refusal_of([&] { return kind.load(bench.file(text)); });
    if (said.empty()) continue;
    ++refusals;
    CHECK_FALSE(holds(said, "\n"));
    CHECK(holds(said, "; "));
  }
  CHECK(refusals > files / 4);  // both happen
  CHECK(refusals < files);
}
