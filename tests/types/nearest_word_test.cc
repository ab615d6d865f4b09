#include "hal/shown_text.h"
#include "tests/support/catch.h"

using namespace jaywalk;

TEST_CASE("words are as far apart as letters must be changed") {
  CHECK(edits_between("", "") == 0);
  CHECK(edits_between("sim", "sim") == 0);
  CHECK(edits_between("", "sim") == 3);
  CHECK(edits_between("sed", "seed") == 1);
  CHECK(edits_between("p3xd", "p3dx") == 2);
  CHECK(edits_between("kitten", "sitting") == 3);
}

TEST_CASE("only what is near is thought to be meant") {
  const std::vector<std::string> known{"sim", "status", "stop"};
  CHECK(did_you_mean("smi", known, "no") == "did you mean sim?");
  CHECK(did_you_mean("stauts", known, "no") == "did you mean status?");
  CHECK(did_you_mean("campaign", known, "no") == "no");
  CHECK(did_you_mean("", known, "no") == "no");
  CHECK(did_you_mean("sim", {}, "no") == "no");
}

TEST_CASE("a negative nothing is shown as nothing, and every other number as it is") {
  CHECK(without_minus_zero("at -0.00, -0.0, -0, -0.01 and -0.5, -10.00") == "at 0.00, 0.0, 0, -0.01 and -0.5, -10.00");
  CHECK(without_minus_zero("-0.00,-0.000 1e-05 run-0 2026-01-02 -0.00rad") ==
        "0.00,0.000 1e-05 run-0 2026-01-02 0.00rad");
}
