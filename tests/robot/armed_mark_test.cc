#include "firmware/robot/armed_mark.h"

#include "hal/types/errors.h"
#include "tests/recording/scratch.h"
#include "tests/support/catch.h"

namespace jaywalk {
namespace {

TEST_CASE("a run that ended in order leaves no mark; one that was killed while armed does") {
  const Scratch scratch;
  const std::string socket = scratch.path("control");
  {
    ArmedMark run(socket);
    CHECK_FALSE(run.was_left());
    run.set();
    CHECK(ArmedMark(socket).was_left());  // what a run would see that is started after a kill now
  }
  CHECK_FALSE(ArmedMark(socket).was_left());
}

TEST_CASE("a run that never armed leaves the mark of the one before") {
  const Scratch scratch;
  const std::string socket = scratch.path("control");
  auto* killed = new ArmedMark(socket);  // its end never comes
  killed->set();
  { const ArmedMark did_not_arm(socket); }
  CHECK(ArmedMark(socket).was_left());
  delete killed;
}

TEST_CASE("a mark that cannot be written keeps a run from starting") {
  ArmedMark run("/nowhere/at/all/control");
  CHECK_THROWS_AS(run.set(), StartupError);
}

}  // namespace
}  // namespace jaywalk
