#include "apps/campaign/report.h"

#include <cmath>
#include <limits>

#include "apps/campaign/campaign_folder.h"
#include "tests/recording/scratch.h"
#include "tests/support/catch.h"
#include "tests/support/text.h"

using jaywalk::count_of, jaywalk::holds, jaywalk::refusal_of, jaywalk::Scratch;
using namespace jaywalk::campaign;

namespace {

Plan two_runs() {
  Plan plan;
  for (const std::uint64_t seed : {1U, 2U}) {
    const std::string number = std::to_string(seed), folder = "a/movers.count=4/room/" + number;
    const std::string command = "jaywalk sim room.toml --seed " + number + " --out out/" + folder;
    plan.runs.push_back({"movers.count 4", {"4"}, "room", seed, folder, {}, command, {}, 0.5});
  }
  return plan;
}

Campaign campaign() {
  const Experiment experiment{"a", "A", {}, {}, false, {{{"movers.count", {"4"}, ""}}}, ""};
  return {"", "Made <up>", Keep::kFailures, {experiment}};
}

RunResult result(const std::string& outcome) {
  RunResult made;
  made.outcome = outcome;
  made.success = outcome == "reached";
  made.reason = made.success ? "" : "mover 1 | had to turn";
  made.at_s = 2.5;
  made.figures = {{"path_length_m", 12.0}, {"static_shortest_path_m", 10.0}, {"duration_s", 25.0}, {"contacts", 0.0}};
  made.figures["min_mover_clearance_m"] = made.success ? 0.5 : 0.2;
  made.figures["contacts_caused"] = made.success ? 0.0 : 1.0;
  made.figures["loops"] = made.success ? 0.0 : 2.0;
  made.turns[0] = 3, made.turns[17] = 1;
  return made;
}

std::string text() { return plan_text(campaign(), two_runs(), "no such program"); }

void finish(const CampaignFolder& folder, const PlannedRun& run, const std::string& outcome) {
  std::filesystem::create_directories(folder.begin(run));
  folder.finish(run, result(outcome), Keep::kFailures);
}

}  // namespace

TEST_CASE("a report of two shards has the figures of both, the paper's beside them, and each failure's command") {
  const Scratch scratch;
  const Plan plan = two_runs();
  {
    const CampaignFolder first(scratch.folder() / "s1", text(), {1, 2}),
        second(scratch.folder() / "s2", text(), {2, 2});
    finish(first, plan.runs[0], "reached"), finish(second, plan.runs[1], "forced_mover");
  }
  const ReportPage merged = page_of({scratch.folder() / "s2", scratch.folder() / "s1"});
  CHECK(merged.missing == 0);
  const std::string page = markdown_of(merged);
  CHECK(holds(page, "| A | 1 of 2 |"));
  CHECK(holds(page, "| the paper, on its own maps | 92.5 % |"));
  CHECK(holds(page, "| movers.count 4 | 1 of 2 | 50.0 % (9-91) | 1 | 0 | 0 | 0 | 0 | 2 | 1 | 0 | 0 | 1 |"));
  CHECK(holds(page, "1.20 / 1.20 / 1.20 | 5.0 / 5.0 / 5.0"));  // 12 m over 10 m; 25 s less 10 m at 0.5 m/s
  CHECK(holds(page, "| 0.35 / 0.20 / 0.20 |"));                // 5th percentile and least of two runs are the lesser
  CHECK(holds(page, "Success by scenario"));
  CHECK(holds(page, "| movers.count 4 | 75.00 | 0.00 | 0.00 | 0.00 | 0.00 | 25.00 |"));
  CHECK(holds(page,
              "1. a/movers.count=4/room/2: forced_mover at 2.50 s: mover 1 | had to turn\n   `jaywalk sim room.toml "
              "--seed 2 --out "));
  CHECK(holds(html_of(merged), "Made &lt;up&gt;"));
}

TEST_CASE("a report shows cards, a row a run that can be sorted, and files that any system can name") {
  const Scratch scratch;
  const Plan plan = two_runs();
  const CampaignFolder folder(scratch.folder() / "one", text(), {1, 1});
  finish(folder, plan.runs[0], "reached"), finish(folder, plan.runs[1], "forced_mover");
  const std::string page = html_of(page_of({scratch.folder() / "one"}));
  CHECK(holds(page, "<div><b>1 of 2</b>succeeded: 9 to 91 % (95 %)</div>"));
  CHECK(holds(page, "<div><b>1</b>runs with a loop</div>"));
  CHECK(holds(
      page,
      "<td><a href=\"../a/movers.count=4/room/1/\">a/movers.count=4/room/1</a></td><td>reached</td><td>25.0</td>"));
  CHECK(holds(page, "download=\"All_runs.csv\""));
  CHECK(holds(page, "download=\"Turning_angles_every_0_25_m_of_all.csv\""));
  CHECK(holds(page, "<title>170 to 180 degrees: 25.00 %</title>"));
}

TEST_CASE("settings that differ in one option are compared run by run over shared seeds") {
  // Lost 1 to 5 s more: 3 s on average; standard deviation 1.581 s, t(4) by the expansion 2.731: half 1.93 s.
  ReportedExperiment experiment;
  experiment.axes = {"movers.count", "mode"};
  std::vector<PlannedRun> runs(5);
  for (std::uint64_t k = 0; k < 5; ++k) runs[k].scenario = "room", runs[k].seed = k, runs[k].cruise_mps = 0.5;
  ReportedTables tables{
      &experiment, {{"4, full", {"4", "full"}, {}}, {"8, full", {"8", "full"}, {}}, {"8, paper", {"8", "paper"}, {}}}};
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t k = 0; k < 5; ++k) {
      ReportedRun run{&runs[k], result("reached"), {}};
      if (row == 2) run.result.figures["duration_s"] += 1.0 + static_cast<double>(k);
      tables.rows[row].runs.push_back(run);
    }
  }
  const ReportTable paired = paired_table(tables);
  REQUIRE(paired.rows.size() == 1);  // 8 movers against 4 are other worlds
  CHECK(paired.rows[0][0] == "8, paper, less 8, full");
  CHECK(paired.rows[0][1] == "0.0 (0.0 to 0.0), 5");
  CHECK(paired.rows[0][3] == "3.0 (1.1 to 4.9), 5");
  tables.rows[2].runs.pop_back();
  CHECK(paired_table(tables).rows.empty());  // four pairs prove nothing
}

TEST_CASE("a report has a table of people where the robot moved any, and none elsewhere") {
  ReportedExperiment experiment;
  PlannedRun run;
  ReportedTables tables{&experiment, {{"orca", {}, {{&run, result("reached"), {}}}}}};
  const auto people = [&] {
    for (const ReportTable& table : tables_of(tables))
      if (table.title.starts_with("People")) return table.rows[0];
    return std::vector<std::string>();
  };
  CHECK(people().empty());
  for (const auto& [name, value] :
       {std::pair{"intimate_s", 0.5}, {"personal_s", 4.0}, {"slowed_m", 2.0}, {"turned_rad", 3.0}})
    tables.rows[0].runs[0].result.figures[name] = value;
  CHECK(people() ==
        std::vector<std::string>{"orca", "0.5 / 0.5 / 0.5", "4.0 / 4.0 / 4.0", "2.0 / 2.0 / 2.0", "3.0 / 3.0 / 3.0"});
}

TEST_CASE("a report says what is missing, and does not mix campaigns") {
  const Scratch scratch;
  const Plan plan = two_runs();
  { finish(CampaignFolder(scratch.folder() / "one", text(), {1, 1}), plan.runs[0], "reached"); }
  const ReportPage page = page_of({scratch.folder() / "one"});
  CHECK(page.missing == 1);
  CHECK(holds(markdown_of(page), "1 runs are missing"));
  { const CampaignFolder other(scratch.folder() / "two", text() + " ", {1, 1}); }
  const std::vector<std::filesystem::path> both{scratch.folder() / "one", scratch.folder() / "two"};
  CHECK(holds(refusal_of([&] { return page_of(both); }), "holds another campaign"));
  CHECK(holds(refusal_of([&] { return page_of({scratch.folder()}); }), "holds no campaign"));
  CHECK(holds(refusal_of([&] { CampaignFolder(scratch.folder() / "two", text(), {1, 1}); }), "holds another campaign"));
}

TEST_CASE("one share is one process's, and what it left half done is none") {
  const Scratch scratch;
  const PlannedRun run = two_runs().runs[0];
  const CampaignFolder folder(scratch.folder(), text(), {1, 2});
  CHECK(holds(refusal_of([&] { CampaignFolder(scratch.folder(), text(), {1, 2}); }), "another process runs its share"));
  scratch.write("runs/" + run.folder + ".part-1-of-2/run.json", "half");
  CHECK_FALSE(folder.is_finished(run));
  CHECK(std::filesystem::is_empty(folder.begin(run)));
  folder.finish(run, result("reached"), Keep::kAll);
  CHECK(folder.is_finished(run));
  CHECK_FALSE(std::filesystem::exists(folder.work(run)));
}

TEST_CASE("a successful run keeps its figures, a failed one everything") {
  const Scratch scratch;
  const Plan plan = two_runs();
  const CampaignFolder folder(scratch.folder(), text(), {1, 1});
  for (const PlannedRun& run : plan.runs) std::ofstream(folder.begin(run) / "recording.jwr") << "long";
  folder.finish(plan.runs[0], result("reached"), Keep::kFailures);
  folder.finish(plan.runs[1], result("timeout"), Keep::kFailures);
  CHECK_FALSE(std::filesystem::exists(place_of(scratch.folder(), plan.runs[0]) / "recording.jwr"));
  CHECK(std::filesystem::exists(place_of(scratch.folder(), plan.runs[1]) / "recording.jwr"));
}

TEST_CASE("charts hold the lines and the paper's points") {
  const std::string svg = success_chart({{"ours <1>", {{1.0, 4, 4}, {16.0, 2, 4}}}});
  CHECK(holds(svg, "ours &lt;1&gt;"));
  CHECK(count_of("<circle", svg) == 2 + 6);
}

TEST_CASE("an experiment of several maps has a small chart a map, all with the same axes") {
  ReportedExperiment experiment;
  experiment.scenarios = {"hall", "room"};
  std::vector<PlannedRun> runs(3);
  for (PlannedRun& run : runs) run.scenario = "room", run.cruise_mps = 0.5;
  runs[0].scenario = "hall";
  ReportedTables tables{&experiment, {{"all", {}, {}}}};
  for (const PlannedRun& run : runs) tables.rows[0].runs.push_back({&run, result("reached"), {}});
  tables.rows[0].runs[1].result.figures["duration_s"] = 57.0;  // 37 s lost; 40 is the next round figure
  tables.rows[0].runs[2].result = result("timeout");
  const std::string svg = map_chart(tables);
  CHECK(count_of(">hall</text>", svg) == 1);
  CHECK(count_of(">room</text>", svg) == 1);
  CHECK(count_of(">40</text>", svg) == 2);
  CHECK(count_of(">0</text>", svg) == 2);
  CHECK(holds(svg, "<title>all, seed 0: 37.0</title>"));
  CHECK(holds(svg, "<title>all, seed 0: did not arrive</title>"));
  CHECK(count_of("<circle", svg) == 3);
  experiment.scenarios.pop_back();
  CHECK(map_chart(tables).empty());
}

TEST_CASE("success stands by movers, and a dash where nothing was run") {
  const ReportTable table = success_table({{"ours", {{2.0, 3, 4}, {32.0, 1, 4}}}, {"theirs", {{0.0, 4, 4}}}});
  CHECK(table.head == std::vector<std::string>{"", "0", "2", "32"});
  CHECK(table.rows == std::vector<std::vector<std::string>>{{"ours", "-", "3 of 4", "1 of 4"},
                                                            {"theirs", "4 of 4", "-", "-"},
                                                            {"the paper, on its own maps", "-", "95.0 %", "-"}});
}

TEST_CASE("the interval of a share is Wilson's: all of few runs is not certainty, and no runs say nothing") {
  // 33 of 40, z = 1.96, z^2 = 3.8416: centre (33 + 1.9208) / 43.8416 = 0.79652; half width 1.96 / 43.8416 *
  // sqrt(33 * 7 / 40 + 0.9604) = 0.044706 * sqrt(6.7354) = 0.11602
  CHECK(wilson(33, 40).low == Approx(0.68050).margin(1e-4));
  CHECK(wilson(33, 40).high == Approx(0.91254).margin(1e-4));
  CHECK(wilson(2, 2).low == Approx(2.0 / 5.8416).margin(1e-4));  // n / (n + z^2)
  CHECK(wilson(2, 2).high == 1.0);
  CHECK(wilson(0, 2).low == 0.0);
  CHECK(wilson(0, 0).low == 0.0);
  CHECK(wilson(0, 0).high == 1.0);
}

TEST_CASE("medians and quantiles leave out what nobody knows") {
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  CHECK(median({3.0, unknown, 1.0, 2.0}) == 2.0);
  CHECK(median({4.0, 1.0}) == 2.5);
  CHECK(quantile({1.0, 2.0, 3.0, 4.0}, 0.5) == 2.0);
  CHECK(quantile({1.0, 2.0, 3.0, 4.0}, 0.95) == 4.0);
  CHECK(quantile({unknown, 7.0}, 1.0) == 7.0);
  CHECK(mean({1.0, unknown, 3.0}) == 2.0);
  CHECK(std::isnan(median({unknown})));
  CHECK(std::isnan(mean({})));
}

TEST_CASE("numbers are written alike everywhere") {
  CHECK(fixed(1.005, 1) == "1.0");
  CHECK(fixed(-2.0, 0) == "-2");
  CHECK(fixed(std::numeric_limits<double>::quiet_NaN(), 2) == "-");
}

TEST_CASE("digests are those of FNV-1a") {
  CHECK(digest_of_text("") == "cbf29ce484222325");   // the offset
  CHECK(digest_of_text("a") == "af63dc4c8601ec8c");  // published test vector
}
