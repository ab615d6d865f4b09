// The tables of keys and the parsers that use them.
#include <set>
#include <stdexcept>

#include "hal/toml_file.h"
#include "hal/types/errors.h"
#include "planner/motion/blind_rim.h"
#include "tests/robot/settings_bench.h"
#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

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
