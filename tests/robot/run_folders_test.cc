#include "firmware/recording/run_folders.h"

#include <fstream>
#include <iterator>

#include "firmware/robot/run_status.h"
#include "hal/types/errors.h"
#include "tests/recording/scratch.h"
#include "tests/support/catch.h"

namespace jaywalk {
namespace {

using std::filesystem::exists;

/// 2026-11-24T20:15:00Z, and so many seconds.
std::chrono::system_clock::time_point at(int seconds) {
  return std::chrono::system_clock::from_time_t(1795551300 + seconds);
}

std::filesystem::path run_of(const Scratch& all, int at_s, std::size_t bytes, const RunsKept& kept = {}) {
  RunFolder folder(all.path("runs"), at(at_s));
  std::ofstream(folder.path() / "recording.jwr") << std::string(bytes, 'x');
  folder.keep(kept);
  return folder.path();
}

TEST_CASE("a run's folder is named after its start, a second one of that second gets a number") {
  const Scratch all;
  CHECK(run_of(all, 0, 1).filename() == "2026-11-24T20-15-00Z");
  CHECK(run_of(all, 0, 1).filename() == "2026-11-24T20-15-00Z-2");
  CHECK(run_of(all, 1, 1).filename() == "2026-11-24T20-15-01Z");
}

TEST_CASE("the oldest runs give way, by number and by size, what is not a run stays") {
  const Scratch all;
  std::filesystem::create_directories(all.path("runs/notes"));
  const auto first = run_of(all, 0, 100), second = run_of(all, 1, 100), third = run_of(all, 2, 100);
  const auto fourth = run_of(all, 3, 100, {.runs = 3});
  CHECK_FALSE(exists(first));
  CHECK((exists(second) && exists(third) && exists(fourth)));
  const auto fifth = run_of(all, 4, 100, {.runs = 100, .bytes = 250});  // 300 are there: the oldest goes
  CHECK_FALSE(exists(second));
  CHECK((exists(third) && exists(fourth) && exists(fifth)));
  const auto sixth = run_of(all, 5, 100, {.runs = 1});
  CHECK_FALSE(exists(fifth));
  CHECK((exists(sixth) && exists(all.path("runs/notes"))));
}

TEST_CASE("starts that fail, however many, leave no folder and push no run out") {
  const Scratch all;
  const auto run = run_of(all, 0, 100);
  for (int k = 1; k < 40; ++k) {
    const RunFolder failed(all.path("runs"), at(k));
    CHECK(exists(failed.path()));
  }
  CHECK(exists(run));
  CHECK(std::distance(std::filesystem::directory_iterator(all.path("runs")), {}) == 1);
}

TEST_CASE("a place where no folder can be made is refused") {
  CHECK_THROWS_AS(RunFolder("/proc/nothing/here", at(0)), StartupError);
}

TEST_CASE("a folder that holds a run's recording, or parts of one, is set aside, and nothing in it is written over") {
  const Scratch all;
  const std::filesystem::path out = all.path("run");
  CHECK(set_aside(out).empty());
  std::filesystem::create_directories(out / "part-000003");
  std::ofstream(out / "part-000003" / "recording.jwr") << "a crash";
  CHECK(set_aside(out.string() + "/") == all.path("run.1"));
  std::filesystem::create_directories(out);
  std::ofstream(out / "notes") << "no run";
  CHECK(set_aside(out).empty());
  std::ofstream(out / "recording.jwr") << "another";
  {
    const OutFolder writes(out);
    CHECK_THROWS_AS(set_aside(out), StartupError);
  }
  CHECK(set_aside(out) == all.path("run.2"));
  CHECK(all.read("run.1/part-000003/recording.jwr") == "a crash");
  CHECK(all.read("run.2/notes") == "no run");
  CHECK_FALSE(exists(out));
}

TEST_CASE("what drives said and what was lost is never silently left out") {
  const Scratch disk;  // both files are where no space is left
  for (const char* name : {"arming.txt", "devices.json"}) std::filesystem::create_symlink("/dev/full", disk.path(name));
  CHECK_THROWS_AS(write_arming(disk.folder(), {"left 0x6065: 10"}), StartupError);
  CHECK_THROWS_AS(write_devices(disk.folder(), {}, {}, {}), StartupError);
  CHECK_THROWS_AS(write_devices(disk.path("nowhere"), {}, {}, {}), StartupError);
}

TEST_CASE("settings that are not proved are counted by themselves") {
  CHECK(in_short({"left 0x6065: 10", "right 0x6065: 10"}) == "2 settings proved");
  CHECK(in_short({"left 0x6065: 10", "right 0x6065: NOT PROVED"}) == "1 settings proved, 1 NOT PROVED");
}

}  // namespace
}  // namespace jaywalk
