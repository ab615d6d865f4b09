#include <unistd.h>

#include <cstdlib>
#include <fstream>

#include "firmware/robot/commissioned.h"
#include "hal/types/errors.h"
#include "tests/recording/scratch.h"
#include "tests/support/catch.h"

namespace jaywalk {
namespace {

TEST_CASE("a run that ended in order leaves no mark, one that was killed while armed does, for the same robot alone") {
  const Scratch scratch;
  {
    ArmedMark run(scratch.path(""), "can0");
    CHECK_FALSE(run.was_left());
    run.set();
    CHECK(ArmedMark(scratch.path(""), "can0").was_left());  // what a run would see that is started after a kill now
    CHECK_FALSE(ArmedMark(scratch.path(""), "can1").was_left());
  }
  CHECK_FALSE(ArmedMark(scratch.path(""), "can0").was_left());
}

TEST_CASE("a run that never armed leaves the mark of the one before") {
  const Scratch scratch;
  auto* killed = new ArmedMark(scratch.path(""), "can0");  // its end never comes
  killed->set();
  { const ArmedMark did_not_arm(scratch.path(""), "can0"); }
  CHECK(ArmedMark(scratch.path(""), "can0").was_left());
  delete killed;
}

TEST_CASE("a mark that cannot be written keeps a run from starting") {
  CHECK_THROWS_AS(ArmedMark("/nowhere/at/all", "can0"), StartupError);
}

TEST_CASE("a link in the mark's place is not followed, and latches") {
  const Scratch scratch;
  std::ofstream(scratch.path("precious")) << "kept";
  std::filesystem::create_symlink(scratch.path("precious"), scratch.path("jaywalk-can0.armed"));
  ArmedMark run(scratch.path(""), "can0");
  CHECK(run.was_left());
  CHECK_THROWS_AS(run.set(), StartupError);
  std::string kept;
  std::ifstream(scratch.path("precious")) >> kept;
  CHECK(kept == "kept");
}

TEST_CASE("where the package has made a folder for marks every user's run uses it, or does not start") {
  const Scratch scratch;
  const std::filesystem::path shared = scratch.path("shared");
  CHECK(folder_of_marks(shared) == own_runtime_folder());
  std::filesystem::create_directory(shared);
  std::filesystem::permissions(shared, std::filesystem::perms::owner_all | std::filesystem::perms::group_all);
  CHECK(folder_of_marks(shared) == shared);
  ArmedMark service(folder_of_marks(shared), "can0");
  service.set();
  CHECK(ArmedMark(folder_of_marks(shared), "can0").was_left());
  CHECK(std::filesystem::status(shared / "jaywalk-can0.armed").permissions() ==
        (std::filesystem::perms::owner_read | std::filesystem::perms::owner_write | std::filesystem::perms::group_read |
         std::filesystem::perms::group_write));
  std::filesystem::permissions(shared, std::filesystem::perms::all);
  CHECK_THROWS_AS(folder_of_marks(shared), StartupError);  // anybody's
  std::filesystem::create_directory_symlink(shared, scratch.path("link"));
  CHECK_THROWS_AS(folder_of_marks(scratch.path("link")), StartupError);
}

TEST_CASE("the folder for marks is this user's alone: one that is a link, or where others may write, is passed over") {
  const Scratch scratch;
  const std::string before = std::getenv("XDG_RUNTIME_DIR") != nullptr ? std::getenv("XDG_RUNTIME_DIR") : "";
  const std::filesystem::path mine = scratch.path("mine"), link = scratch.path("link");
  ::setenv("XDG_RUNTIME_DIR", mine.c_str(), 1);
  CHECK(own_runtime_folder() == mine);
  CHECK(std::filesystem::status(mine).permissions() == std::filesystem::perms::owner_all);
  std::filesystem::permissions(mine, std::filesystem::perms::all);
  CHECK(own_runtime_folder() != mine);
  std::filesystem::permissions(mine, std::filesystem::perms::owner_all);
  std::filesystem::create_directory_symlink(mine, link);
  ::setenv("XDG_RUNTIME_DIR", link.c_str(), 1);
  CHECK(own_runtime_folder() != link);
  before.empty() ? ::unsetenv("XDG_RUNTIME_DIR") : ::setenv("XDG_RUNTIME_DIR", before.c_str(), 1);
}

}  // namespace
}  // namespace jaywalk
