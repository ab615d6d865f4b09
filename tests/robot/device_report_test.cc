#include "firmware/robot/run_status.h"
#include "hal/types/errors.h"
#include "tests/recording/scratch.h"
#include "tests/support/catch.h"

using namespace jaywalk;

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
