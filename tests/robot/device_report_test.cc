#include <unistd.h>

#include <filesystem>
#include <string>

#include "firmware/robot/run_status.h"
#include "hal/types/errors.h"
#include "tests/support/catch.h"

using namespace jaywalk;
namespace fs = std::filesystem;

namespace {

/// A folder in which both files are on a disk that has no space left.
struct FullDisk {
  FullDisk() : folder(fs::temp_directory_path() / ("jaywalk_device_report_" + std::to_string(::getpid()))) {
    fs::create_directories(folder);
    for (const char* name : {"arming.txt", "devices.json"}) fs::create_symlink("/dev/full", folder / name);
  }
  ~FullDisk() { fs::remove_all(folder); }
  fs::path folder;
};

}  // namespace

TEST_CASE("what drives said and what was lost is never silently left out") {
  const FullDisk disk;
  CHECK_THROWS_AS(write_arming(disk.folder, {"left 0x6065: 10"}), StartupError);
  CHECK_THROWS_AS(write_devices(disk.folder, {}, {}, {}), StartupError);
  CHECK_THROWS_AS(write_devices(disk.folder / "nowhere", {}, {}, {}), StartupError);
}

TEST_CASE("settings that are not proved are counted by themselves") {
  CHECK(in_short({"left 0x6065: 10", "right 0x6065: 10"}) == "2 settings proved");
  CHECK(in_short({"left 0x6065: 10", "right 0x6065: NOT PROVED"}) == "1 settings proved, 1 NOT PROVED");
}
