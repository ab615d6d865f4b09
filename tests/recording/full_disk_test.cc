// What is left of a run whose disk fills up while it lasts.
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/report/run_report.h"
#include "tests/recording/made_ticks.h"
#include "tests/recording/scratch.h"
#include "tests/support/catch.h"
#include "tests/support/file_size_limit.h"
#include "tests/support/text.h"

namespace jaywalk {

TEST_CASE("a table on a full disk ends with its last whole row") {
  // A header of 4 bytes and rows of 6: in 100 bytes there is room for 16 rows, which end at byte 100; in 99 for 15.
  for (const auto& [bytes, rows] : {std::pair{100U, 16U}, {99U, 15U}, {95U, 15U}, {94U, 15U}, {93U, 14U}}) {
    const Scratch scratch;
    {
      const FileSizeLimit disk(bytes);
      CsvFile csv(scratch.path("t.csv"), "row");
      for (std::uint64_t k = 0; k < 40; ++k) {
        csv.count(10'000 + k).end_row();
        if (k % 3 == 0) csv.write_out();
      }
      CHECK_FALSE(csv.close());
      CHECK(holds(csv.complaint(), "t.csv: the disk takes no more of it: "));
    }
    const std::string left = scratch.read("t.csv");
    CHECK(left.size() == 4 + 6 * rows);
    CHECK(left.substr(left.size() - 6) == std::to_string(10'000 + rows - 1) + "\n");
  }
}

TEST_CASE("a recording on a full disk is read up to the last tick that it took whole") {
  const Scratch scratch;
  const std::string file = scratch.path("recording.jwr");
  std::uint32_t refused_from = 0;
  {
    const FileSizeLimit disk(20'000);
    Recorder recorder({file, "setup", 8});
    CHECK_FALSE(recorder.is_losing());
    for (std::uint32_t n = 0; n < 400; ++n) {
      record_tick(recorder, n);
      if (!recorder.drain() && refused_from == 0) refused_from = n;
    }
    CHECK(recorder.is_losing());
    CHECK(holds(recorder.complaint(), "recording.jwr: the disk takes no more of it: "));
    CHECK(recorder.dropped() == 0);  // the ring empties all the same
    CHECK_FALSE(recorder.close());
  }
  RecordingReader reader(file);
  const auto read = std::make_unique<TickRecord>();
  std::uint32_t ticks = 0;
  while (reader.next(*read)) REQUIRE(read->now == time_of(ticks++));
  CHECK(holds(reader.warning(), "cut short after"));
  // Told within 0.1 s, 6 ticks, of the first tick that is missing.
  CHECK(refused_from >= ticks);
  CHECK(refused_from <= ticks + 6);
  // No entry that would have fitted is missing: the largest here has 1 kB.
  CHECK(std::filesystem::file_size(file) > 19'000);
}

TEST_CASE(
    "a table that the disk does not take is told within half a second of the ticks' time, and the run has a summary") {
  const Scratch scratch;
  const auto record = std::make_unique<TickRecord>();
  RunReport report(scratch.folder());
  std::uint32_t told_at = 0;
  {
    const FileSizeLimit disk(4'000);
    for (std::uint32_t n = 0; n < 100; ++n) {
      record->now = time_of(n);
      report.add({.record = *record});
      if (told_at == 0 && !report.complaints().empty()) told_at = n;
    }
  }
  // A row has some 100 bytes: the 40th is one too many.
  CHECK(told_at > 30);
  CHECK(told_at <= 75);
  REQUIRE(report.complaints().size() == 1);
  CHECK(holds(report.complaints()[0], "robot.csv: the disk takes no more"));
  const auto summary = nlohmann::json::parse(report.finish({.outcome = "stopped"}));
  CHECK(summary["ticks"] == 100);
  CHECK(summary["not_recorded"].size() == 1);
  const std::string rows = scratch.read("robot.csv");
  CHECK(rows.size() <= 4'000);
  CHECK(rows.back() == '\n');
  CHECK(holds(scratch.read("tracks.csv"), "pedestrian\n"));
}

TEST_CASE("a run holds room for its summary until its end, and refuses to begin where there is none") {
  const Scratch scratch;
  {
    RunReport report(scratch.folder());
    CHECK(std::filesystem::file_size(scratch.path(".reserve")) == 65'536);
    static_cast<void>(report.finish({}));
    CHECK_FALSE(std::filesystem::exists(scratch.path(".reserve")));
  }
  const FileSizeLimit disk(1'000);  // EFBIG is no full disk: begun all the same
  const RunReport report(scratch.folder());
}

}  // namespace jaywalk
