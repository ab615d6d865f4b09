// Scanners of a robot file: what they must see, and several of them.
#include <cmath>

#include "tests/robot/robot_file_text.h"

using namespace jaywalk;
using namespace jaywalk::tests;

TEST_CASE("a file that blinds the robot ahead is refused, a gap that is as wide as a post is not") {
  const auto laser = [](const std::string& keys) { return with("range_m = 10.0", "range_m = 10.0\n" + keys); };
  const auto blanked = [&](double from_deg, double to_deg) {
    return kGood + "\n[[laser.blanked]]\nfrom_deg = " + std::to_string(from_deg) +
           "\nto_deg = " + std::to_string(to_deg) + "\n";
  };
  CHECK(holds(refusal(blanked(-100.0, 100.0)), "laser.mount, fov_deg, blanked: the laser does not look at"));
  CHECK(holds(refusal(blanked(-30.0, 30.0)), "of the way ahead"));
  CHECK(refusal(blanked(10.0, 14.0)) == "loaded");
  CHECK(refusal(blanked(100.0, 130.0)) == "loaded");
  CHECK(holds(refusal(laser("mount = [0.0, 0.0, 3.14159]")), "100 % of the way ahead"));
  CHECK(holds(refusal(laser("mount = [0.1, 0.0, 2.5]")), "of the way ahead"));
  CHECK(refusal(laser("mount = [0.1, 0.0, 0.3]")) == "loaded");
  CHECK(holds(refusal(laser("fov_deg = 30.0\nbeams = 200\nmount = [0.2, 0.0, 0.0]")), "max_speed_mps = 0.3"));
  CHECK(holds(refusal(laser("mount = [5.0, 0.0, 0.0]")), "laser.mount: the laser stands 4.8 m off the body; "));
  CHECK(refusal(laser("mount = [0.3, 0.1, 0.0]")) == "loaded");
}

TEST_CASE("half of the way may be out of sight of a robot that does not go faster than 0.3 m/s") {
  const std::string gap = "\n[[laser.blanked]]\nfrom_deg = 0\nto_deg = 40\n";
  CHECK(holds(refusal(kGood + gap), "for up to half of the way, set max_speed_mps = 0.3"));
  CHECK(refusal(with("max_speed_mps = 0.5", "max_speed_mps = 0.3") + gap) == "loaded");
  CHECK(refusal(with("max_speed_mps = 0.5", "max_speed_mps = 0.3") +
                "\n[[laser.blanked]]\nfrom_deg = -60\nto_deg = 60\n") != "loaded");
}

TEST_CASE("[[laser]] once is [laser], and each further one is a scanner with a wire and a mount of its own") {
  CHECK(load(with("[laser]", "[[laser]]")).lasers().size() == 1);
  const std::string rear =
      "[[laser]]\nkind = \"ld19\"\ndevice = \"/dev/ttyUSB1\"\nmount = [-0.2, 0.0, 3.14]\nbeams = 720\n";
  const RobotFile robot = load(with("[laser]", "[[laser]]") + rear);
  REQUIRE(robot.lasers().size() == 2);
  CHECK(robot.lasers()[0].host == "10.0.0.2");
  CHECK(robot.lasers()[1].device == "/dev/ttyUSB1");
  REQUIRE(robot.setup.model.lasers().size() == 2);
  CHECK(robot.setup.model.lasers()[1].beams == 720);
  CHECK(robot.setup.model.lasers()[1].range_max_m == 10.0);  // like the first
  CHECK(holds(refusal(with("[laser]", "[[laser]]") + "[[laser]]\nkind = \"hokuyo\"\nhost = \"10.0.0.3\"\n"),
              "laser.mount is missing"));
  const auto second = [](const std::string& port) {
    return refusal(with("[laser]", "[[laser]]") + "[[laser]]\nkind = \"sick-cola-b\"\nhost = \"10.0.0.2\"\n" + port +
                   "mount = [-0.2, 0.0, 3.14]\n");
  };
  CHECK(second("") == "17: laser.host is another scanner's already; give each its own address");
  CHECK(second("port = 2113\n") == "loaded");
}

TEST_CASE("of several scanners the first alone may come from ROS 2") {
  const std::string front = with("[laser]\nkind = \"sick-cola-b\"\nhost = \"10.0.0.2\"", "[[laser]]\nkind = \"dds\"");
  const std::string rear = "[[laser]]\nkind = \"dds\"\ntopic = \"/scan_rear\"\nmount = [-0.2, 0.0, 3.14]\n";
  CHECK(load(front).lasers()[0].kind == ScannerKind::kDds);
  CHECK(holds(refusal(front + rear), "brings the first scanner alone"));
}

TEST_CASE("two scanners are judged by what they see together, and each by where it stands") {
  const auto looking = [](const std::string& first, const std::string& second) {
    const std::string more = "[[laser]]\nkind = \"hokuyo\"\nhost = \"10.0.0.3\"\n";
    return refusal(with("[laser]", "[[laser]]\n" + first) + more + second);
  };
  const std::string back = "mount = [-0.2, 0.0, 3.14]\nfov_deg = 180\n", ahead = "mount = [0.2, 0.0, 0.0]\n";
  CHECK(holds(refusal(with("[laser]", "[laser]\n" + back)), "does not look at"));
  CHECK(looking(back, ahead) == "loaded");
  CHECK(looking(ahead, back) == "loaded");
  CHECK(holds(looking(ahead, "mount = [-0.9, 0.0, 3.14]\n"), "off the body"));
}
