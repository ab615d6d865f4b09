// `jaywalk setup` on a machine to which nothing is connected: what a person knows.
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "apps/setup/robot_setup.h"
#include "firmware/robot/robot_file.h"
#include "hal/types/errors.h"
#include "hil/far_end/simulated_robot.h"
#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

bool says(const std::string& text, const std::string& words) { return text.find(words) != std::string::npos; }

/// Nothing is connected, and there is no CAN.
class BareMachine final : public Surroundings {
 public:
  std::vector<std::string> can_interfaces() override { return {}; }
  std::unique_ptr<CanBus> open_bus(const std::string& interface) override {
    throw StartupError(interface + ": no such interface", "none");
  }
  std::vector<std::string> serial_lines() override { return {}; }
  std::vector<std::string> hosts() override { return {}; }
  std::vector<std::string> joysticks() override { return {}; }
};

}  // namespace

TEST_CASE("without CAN and scanner a file is written from what a person knows, who is told first what was found") {
  BareMachine machine;
  rig::HandLivingClock clock;
  std::istringstream person("p4dx\np3dx\n\n\n2\n3\n76600\n\n\nsick-cola-b\n127.0.0.1\n9\n\n");
  std::ostringstream said;
  SetupAnswers known(std::nullopt, &person, &said);
  const std::string text = draft_robot(machine, known, clock).text();
  CAPTURE(text, said.str());
  CHECK(said.str().starts_with("Found: no drives: no CAN interface\nFound: no scanner\nmodel: "));
  CHECK(says(said.str(), "p4dx"));  // what is wrong with it, at the prompt
  CHECK(says(text, "kind = \"cia402\""));
  CHECK(says(text, "can = \"can0\""));
  CHECK(says(text, "right_node = 3 "));
  CHECK(says(text, "host = \"127.0.0.1\""));
  CHECK(says(text, "port = 9 "));
}

TEST_CASE("what was answered before a setup was broken off is not asked again") {
  BareMachine machine;
  rig::HandLivingClock clock;
  const std::filesystem::path kept =
      std::filesystem::temp_directory_path() / ("jaywalk_answers_" + std::to_string(::getpid()));
  std::ostringstream said;
  {
    std::istringstream person("p3dx\n\n\n2\n");
    SetupAnswers known(std::nullopt, &person, &said, kept);
    CHECK_THROWS_WITH(draft_robot(machine, known, clock), Catch::Contains("has what was answered"));
  }
  std::istringstream person("3\n76600\n\n\nsick-cola-b\n127.0.0.1\n9\n\n");
  SetupAnswers known(std::nullopt, &person, &said, kept);
  const std::string text = draft_robot(machine, known, clock).text();
  std::filesystem::remove(kept);
  CAPTURE(text, said.str());
  CHECK(says(said.str(), ": p3dx (as answered before)\n"));
  CHECK(says(text, "left_node = 2 "));
  CHECK(says(text, "right_node = 3 "));
  CHECK(says(text, "port = 9 "));
}

TEST_CASE("a model file that the answers name is found beside them, wherever the robot's file is written") {
  BareMachine machine;
  rig::HandLivingClock clock;
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("jaywalk_answers_" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder / "other");
  std::filesystem::copy_file(JAYWALK_EXAMPLES "/jackal.model.toml", folder / "mine.toml");
  std::ofstream(folder / "answers.toml")
      << "model = \"mine.toml\"\n[laser]\nkind = \"sick-cola-b\"\nhost = \"127.0.0.1\"\nport = 9\n[drive]\nkind = "
         "\"cia402\"\nleft_node = 2\nright_node = 3\ncounts_per_wheel_turn = 76600\n";
  SetupAnswers answers(folder / "answers.toml", nullptr, nullptr);
  std::ofstream(folder / "other" / "robot.toml") << draft_robot(machine, answers, clock).text();
  CHECK(load_robot_file(folder / "other" / "robot.toml").setup.model.name == "jackal");
  std::filesystem::remove_all(folder);
}
