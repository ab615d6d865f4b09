#include "apps/report/run_report.h"
#include "firmware/recording/recorder.h"
#include "firmware/recording/run_folders.h"
#include "hal/types/errors.h"
#include "tests/recording/made_ticks.h"
#include "tests/recording/scratch.h"
#include "tests/support/catch.h"

namespace jaywalk {
namespace {

using std::filesystem::exists;

TEST_CASE("the oldest part goes before the next is made, without parts a run lies in its own folder") {
  const Scratch run;
  RunParts parts(run.folder(), {.bytes = 1'000'000, .parts = 3});
  for (int number = 1; number <= 5; ++number) {
    CHECK(parts.number() == number);
    CHECK(part_number(parts.place()) == number);
    CHECK(parts_of(run.folder()).size() == static_cast<std::size_t>(std::min(number, 3)));
    if (number < 5) parts.next();
  }
  CHECK_FALSE(parts.is_full(940'000));
  CHECK(parts.is_full(960'000));
  CHECK(parts_of(run.folder()).front() == run.path("part-000003"));
  const RunParts whole(run.folder(), {});
  CHECK(whole.place() == run.folder());
  CHECK_FALSE(whole.is_full(1'000'000'000));
  CHECK(parts_of(run.folder()).empty());
}

TEST_CASE("a folder that is called like a part and holds no recording is refused, not removed") {
  const Scratch run;
  run.write("part-000001/thesis.tex", "years of work");
  CHECK_THROWS_AS(RunParts(run.folder(), {}), StartupError);
  CHECK_THROWS_AS(RunParts(run.folder(), {.bytes = 1'000'000, .parts = 3}), StartupError);
  CHECK(run.read("part-000001/thesis.tex") == "years of work");
}

TEST_CASE("parts are those after the last gap, by number and not by name, other folders are none") {
  const Scratch run;
  for (const char* const name :
       {"part-000001", "part-000003", "part-999999", "part-1000000", "part-", "part-x", "part-7x", "parts"})
    std::filesystem::create_directories(run.path(name));
  const auto parts = parts_of(run.folder());
  REQUIRE(parts.size() == 2);
  CHECK(parts[0] == run.path("part-999999"));
  CHECK(parts[1] == run.path("part-1000000"));
}

TEST_CASE("a recording goes on in another file with the next tick that is drained, and its scan again") {
  const Scratch scratch;
  Recorder recorder({scratch.path("1.jwr"), "first", 8});
  for (const std::uint32_t n : {0U, 1U}) record_tick(recorder, n);
  REQUIRE(recorder.drain());
  CHECK(recorder.last_drained() == time_of(1));
  const std::uintmax_t bytes = recorder.bytes();
  record_tick(recorder, 2);  // not drained: a tick of the next
  recorder.continue_in(scratch.path("2.jwr"), "second");
  CHECK(std::filesystem::file_size(scratch.path("1.jwr")) == bytes + 12);  // and the end mark
  REQUIRE(recorder.close());
  RecordingReader first(scratch.path("1.jwr")), second(scratch.path("2.jwr"));
  const auto read = std::make_unique<TickRecord>();
  CHECK((first.next(*read) && first.next(*read) && !first.next(*read) && first.warning().empty()));
  CHECK(second.setup() == "second");
  REQUIRE(second.next(*read));
  CHECK(same_bits(*read, *made_tick(2)));
  CHECK_FALSE(second.next(*read));
  CHECK_THROWS_AS(recorder.continue_in("/nowhere/at/all/3.jwr", ""), StartupError);
}

TEST_CASE("tables go on in another folder with the first row later than the part before, whenever they are told") {
  const Scratch run;
  std::filesystem::create_directories(run.path("next"));
  {
    RunReport report(run.folder());
    const auto tell = [&](std::uint32_t n) {
      const auto record = std::make_unique<TickRecord>();
      record->now = time_of(n);
      report.add({.record = *record});
    };
    tell(1);
    report.continue_in(run.path("next"), time_of(2));
    tell(2), tell(3);
    report.finish({});
  }
  const auto rows = [&](const std::string& file) {
    const std::string text = run.read(file);
    return std::count(text.begin(), text.end(), '\n') - 1;
  };
  CHECK(rows("robot.csv") == 2);
  CHECK(rows("next/robot.csv") == 1);
}

}  // namespace
}  // namespace jaywalk
