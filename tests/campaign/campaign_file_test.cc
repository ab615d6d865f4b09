#include "apps/campaign/campaign.h"
#include "tests/campaign/made_campaigns.h"
#include "tests/support/catch.h"

using namespace jaywalk::campaign;

namespace {

const std::string kScenario =
    "[map]\naria = \"room.map\"\n[robot]\nstart = [5, 5, 0]\ngoal = [8, 8]\n[[movers]]\nkind = \"wander\"\ncount = 1\n";
const std::string kRoom =
    "2D-Map\nLineMinPos: 0 0\nLineMaxPos: 10000 10000\nNumLines: 4\nLINES\n0 0 10000 0\n10000 0 10000 10000\n10000 "
    "10000 "
    "0 10000\n0 10000 0 0\n";
const std::string kHead = "[[experiments]]\nname = \"a\"\nscenarios = \"room.toml\"\nseeds = [1, 2]\n";

struct Folder : CampaignScratch {
  Folder() {
    write("room.map", kRoom);
    write("room.toml", kScenario);
  }
  [[nodiscard]] Plan plan(const std::string& text) const { return plan_of(load_campaign(write("c.toml", text))); }
  [[nodiscard]] std::string refused(const std::string& text) const {
    return refusal_of([&] { static_cast<void>(plan(text)); });
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
  CHECK(command_of(plan.runs[7]) ==
        "jaywalk sim room.toml --planner ours --mode paper --constant-speed --set movers.count=2 --set "
        "robot.laser.fov_deg=180 --seed 2 "
        "--out out/a/movers.count=2,mode=paper/room/2");
  CHECK(plan.runs[0].goal == jaywalk::Vec2{8.0, 8.0});
  CHECK(plan.inputs.size() == 2);
}

TEST_CASE("a campaign may name the maps, in its own folder") {
  const Folder folder;
  folder.write("other.map", kRoom);
  folder.write("mapless.toml", kScenario.substr(kScenario.find("[robot]")));
  const Plan plan = folder.plan(
      "[[experiments]]\nname = \"a\"\nscenarios = \"mapless.toml\"\nseeds = [1, 1]\n"
      "set.map.aria = [\"room.map\", \"other.map\"]\nplanner = [\"ours\", \"orca\"]\n");
  REQUIRE(plan.runs.size() == 4);
  CHECK(plan.runs[1].folder == "a/map.aria=room.map,planner=orca/mapless/1");
  CHECK(command_of(plan.runs[1]) ==
        "jaywalk sim mapless.toml --planner orca --mode full --set map.aria=room.map --seed 1 --out "
        "out/a/map.aria=room.map,planner=orca/mapless/1");
  CHECK(plan.inputs.size() == 3);
}

TEST_CASE("a raster map's picture is an input too") {
  const Folder folder;
  folder.write("hall.pgm", "P5 1 1 255\n\xff");
  folder.write("hall.yaml", "image: hall.pgm\nresolution: 8.0\norigin: [0.0, 0.0, 0.0]\n");
  folder.write("mapless.toml", kScenario.substr(kScenario.find("[robot]")));
  const std::string rows = "[[experiments]]\nname = \"a\"\nscenarios = \"mapless.toml\"\nseeds = [1, 1]\n";
  const Plan plan = folder.plan(rows + "set.map.yaml = \"hall.yaml\"\n");
  CHECK(plan.inputs.size() == 3);  // scenario, YAML, picture
}

TEST_CASE("without seeds each scenario is run with its own") {
  const Folder folder;
  folder.write("other.toml", "seed = 42\n" + kScenario);
  const Plan plan = folder.plan("[[experiments]]\nname = \"a\"\nscenarios = [\"room.toml\", \"other.toml\"]\n");
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
  CHECK(holds(folder.refused(kHead + "sceds = 1\n"), "c.toml:5: experiments.sceds is not a known key; "));
  CHECK(holds(folder.refused(kHead + "set.movers.cuont = 3\n"),
              "c.toml:5: experiments.set movers.cuont=3: is not a known key; did you mean movers.count?"));
  CHECK(holds(folder.refused(kHead + "set.movers.count = [3, 900]\n"), "c.toml:5: experiments.set movers.count=900: "));
  CHECK(holds(folder.refused(kHead + "set.movers.count = []\n"), "c.toml:5: "));
  CHECK(holds(folder.refused(kHead + "mode = \"fast\"\n"), "c.toml:5: experiments.mode is \"fast\"; choose "));
  CHECK(holds(folder.refused(kHead + "set.movers.count = [3, 3]\n"), "two runs are called a/movers.count=3/room/1; "));
  CHECK(holds(folder.refused(kHead + kHead), "experiments.name a is there already; "));
  CHECK(holds(folder.refused("name = \"x\"\n"), "experiments is missing; "));
  CHECK(holds(folder.refused("[[experiments]]\nname = \"../a\"\n"),
              "c.toml:2: experiments.name is no name of a folder; "));
  CHECK(holds(folder.refused("[[experiments]]\nname = \"a\"\nscenarios = \"none.toml\"\nseeds = [1, 1]\n"),
              "c.toml:2: "));
  CHECK(holds(folder.refused("[[experiments]]\nname = \"a\"\nscenarios = [3]\nseeds = [1, 1]\n"), "c.toml:3: "));
  for (const char* seeds : {"[2, 1]", "[1.5, 2]", "[-1, 2]", "[1, 9000000]"})
    CHECK(
        holds(folder.refused("[[experiments]]\nname = \"a\"\nscenarios = \"room.toml\"\nseeds = " + std::string(seeds)),
              "c.toml:4: experiments.seeds is no range of seeds; "));
}

TEST_CASE("the campaigns that are shipped can be planned") {
  const std::string folder = JAYWALK_CAMPAIGNS;
  CHECK(plan_of(load_campaign(folder + "/first.toml")).runs.size() == 2);
  // four maps, ten seeds: 8 counts of movers in four rows, 9 in one, 7 on legs
  CHECK(plan_of(load_campaign(folder + "/paper.toml")).runs.size() == 40 * (5 * 8 + 9 + 7));
  CHECK(plan_of(load_campaign(folder + "/baselines.toml")).runs.size() == 4 * 5 * 5 * 3);
  CHECK(plan_of(load_campaign(folder + "/hall_baselines.toml")).runs.size() == 5 * 8);
  CHECK(plan_of(load_campaign(folder + "/results.toml")).runs.size() == 100 * 4);
  CHECK(plan_of(load_campaign(folder + "/harder.toml")).runs.size() == 100 * 5);
  CHECK(plan_of(load_campaign(folder + "/two_scanners.toml")).runs.size() == 25 * 2);
  CHECK(plan_of(load_campaign(folder + "/wheelchair.toml")).runs.size() == 25 * 3);
}
