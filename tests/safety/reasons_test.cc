// The table of reasons and the documents that explain each of them.
#include "firmware/safety/reasons.h"

#include "hal/text_file.h"
#include "tests/support/catch.h"

using namespace jaywalk;

TEST_CASE("each reason has its own bit, name and words, and the documents explain it") {
  const std::string remedies = text_in(JAYWALK_DOCS "/how-to/it-stands-still.md"),
                    kinds = text_in(JAYWALK_DOCS "/explanation/safety.md");
  REQUIRE(remedies.size() > 1000);
  for (const ReasonRow& row : kReasons) {
    CAPTURE(row.name);
    CHECK(reason_named(row.name) == row.reason);
    CHECK(to_string(row.reason) == row.name);
    CHECK(std::ranges::count(kReasons, row.reason, &ReasonRow::reason) == 1);
    const std::string in_table = "`" + std::string(row.name) + "`";
    CHECK(kinds.find(in_table) != std::string::npos);
    if (row.reason != Reason::kLatched) CHECK(remedies.find(in_table) != std::string::npos);
  }
  CHECK(reason_named("scanner_2") == Reason::kNone);
}
