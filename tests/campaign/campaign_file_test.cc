#include "apps/campaign/campaign.h"
#include "tests/recording/scratch.h"
#include "tests/support/catch.h"
#include "tests/support/text.h"

using jaywalk::holds, jaywalk::refusal_of, jaywalk::Scratch;
using namespace jaywalk::campaign;

namespace {

const std::string kScenario =
    "[map]\naria = \"room.map\"\n[robot]\nstart = [5, 5, 0]\ngoal = [8, 8]\n[[movers]]\nkind = \"wander\"\ncount = 1\n";
const std::string kRoom =
    "2D-Map\nLineMinPos: 0 0\nLineMaxPos: 10000 10000\nNumLines: 4\nLINES\n0 0 10000 0\n10000 0 10000 10000\n"
    "10000 10000 0 10000\n0 10000 0 0\n";
const std::string kNamed = "[[experiments]]\nname = \"a\"\n";
const std::string kHead = kNamed + "scenarios = \"room.toml\"\nseeds = [1, 2]\n";
const std::string kMapless = kNamed + "scenarios = \"mapless.toml\"\nseeds = [1, 1]\n";

struct Folder : Scratch {
  Folder() {
    write("room.map", kRoom);
    write("room.toml", kScenario);
    write("mapless.toml", kScenario.substr(kScenario.find("[robot]")));
  }
  [[nodiscard]] Plan plan(const std::string& text) const { return plan_of(load_campaign(write("c.toml", text))); }
  [[nodiscard]] std::string refused(const std::string& text) const {
    return refusal_of([&] { return plan(text); });
  }
};

}  // namespace

TEST_CASE("runs are scenarios times seeds times modes times settings, in the file's order") {
  const Folder folder;
  const Plan plan = folder.plan(kHead +
                                "mode = [\"full\", \"paper\"]\nconstant_speed = true\nset.movers.count = [4, 2]\n"
                                "set.robot.laser.fov_deg = 180.0\n");
  REQUIRE(plan.runs.size() == 8);
  CHECK(plan.runs[0].folder == "a/movers.count=4,mode=full/room/1");
  CHECK(plan.runs[1].folder == "a/movers.count=4,mode=full/room/2");
  CHECK(plan.runs[2].folder == "a/movers.count=4,mode=paper/room/1");
  CHECK(plan.runs[4].row == "movers.count 2, mode full");
  CHECK(plan.runs[7].seed == 2);
  CHECK(plan.runs[7].command ==
        "jaywalk sim room.toml --planner ours --mode paper --constant-speed --set movers.count=2 --set "
        "robot.laser.fov_deg=180 --seed 2 "
        "--out out/a/movers.count=2,mode=paper/room/2");
  CHECK(plan.runs[0].goal == jaywalk::Vec2{8.0, 8.0});
  CHECK(plan.inputs.size() == 2);
}

TEST_CASE("a campaign may name the maps, in its own folder") {
  const Folder folder;
  folder.write("other.map", kRoom);
  const Plan plan =
      folder.plan(kMapless + "set.map.aria = [\"room.map\", \"other.map\"]\nplanner = [\"ours\", \"orca\"]\n");
  REQUIRE(plan.runs.size() == 4);
  CHECK(plan.runs[1].folder == "a/map.aria=room.map,planner=orca/mapless/1");
  CHECK(plan.runs[1].command ==
        "jaywalk sim mapless.toml --planner orca --mode full --set map.aria=room.map --seed 1 --out "
        "out/a/map.aria=room.map,planner=orca/mapless/1");
  CHECK(plan.inputs.size() == 3);
}

TEST_CASE("a raster map's picture is an input too") {
  const Folder folder;
  folder.write("hall.pgm", "P5 1 1 255\n\xff");
  folder.write("hall.yaml", "image: hall.pgm\nresolution: 8.0\norigin: [0.0, 0.0, 0.0]\n");
  CHECK(folder.plan(kMapless + "set.map.yaml = \"hall.yaml\"\n").inputs.size() == 3);  // scenario, YAML, picture
}

TEST_CASE("without seeds each scenario is run with its own") {
  const Folder folder;
  folder.write("other.toml", "seed = 42\n" + kScenario);
  const Plan plan = folder.plan(kNamed + "scenarios = [\"room.toml\", \"other.toml\"]\n");
  REQUIRE(plan.runs.size() == 2);
  CHECK(plan.runs[0].folder == "a/all/room/1");
  CHECK(plan.runs[1].folder == "a/all/other/42");
  CHECK(plan.runs[1].seed == 42);
}

TEST_CASE("what does not vary is no part of a row's name") {
  const Folder folder;
  const Plan plan = folder.plan(kHead + "set.movers.legs = true\n");
  REQUIRE(plan.runs.size() == 2);
  CHECK(plan.runs[0].folder == "a/all/room/1");
  CHECK(plan.runs[0].arguments.at(7) == "movers.legs=true");
}

TEST_CASE("a campaign file is refused with place, cause and remedy") {
  const Folder folder;
  const std::pair<std::string, const char*> all[] = {
      {kHead + "sceds = 1\n", "c.toml:5: experiments.sceds is not a known key; "},
      {kHead + "set.movers.cuont = 3\n",
       "c.toml:5: experiments.set movers.cuont=3: is not a known key; did you mean movers.count?"},
      {kHead + "set.movers.count = [3, 900]\n", "c.toml:5: experiments.set movers.count=900: "},
      {kHead + "set.movers.count = []\n", "c.toml:5: "},
      {kHead + "mode = \"fast\"\n", "c.toml:5: experiments.mode is \"fast\"; choose "},
      {kHead + "set.movers.count = [3, 3]\n", "two runs are called a/movers.count=3/room/1; "},
      {kHead + kHead, "experiments.name a is there already; "},
      {"name = \"x\"\n", "experiments is missing; "},
      {"[[experiments]]\nname = \"../a\"\n", "c.toml:2: experiments.name is no name of a folder; "},
      {kNamed + "scenarios = \"none.toml\"\nseeds = [1, 1]\n", "c.toml:2: "},
      {kNamed + "scenarios = [3]\nseeds = [1, 1]\n", "c.toml:3: "}};
  for (const auto& [text, said] : all) {
    CAPTURE(text);
    CHECK(holds(folder.refused(text), said));
  }
  for (const std::string seeds : {"[2, 1]", "[1.5, 2]", "[-1, 2]", "[1, 9000000]"})
    CHECK(holds(folder.refused(kNamed + "scenarios = \"room.toml\"\nseeds = " + seeds),
                "c.toml:4: experiments.seeds is no range of seeds; "));
}

TEST_CASE("the campaigns that are shipped can be planned") {
  const auto runs = [](const std::string& name) {
    return plan_of(load_campaign(std::string(JAYWALK_CAMPAIGNS) + "/" + name + ".toml")).runs.size();
  };
  CHECK(runs("first") == 2);
  // four maps, ten seeds: 8 counts of movers in four rows, 9 in one, 7 on legs
  CHECK(runs("paper") == 40 * (5 * 8 + 9 + 7));
  CHECK(runs("baselines") == 4 * 5 * 5 * 3);
  CHECK(runs("hall_baselines") == 5 * 8);
  CHECK(runs("results") == 100 * 4);
  CHECK(runs("harder") == 100 * 5);
  CHECK(runs("two_scanners") == 25 * 2);
  CHECK(runs("wheelchair") == 25 * 3);
}
