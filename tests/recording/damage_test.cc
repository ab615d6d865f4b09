// Recordings that a disk, a network or a power cut has been at.
#include <cstdint>
#include <memory>
#include <random>
#include <string>

#include "firmware/recording/recorder.h"
#include "tests/recording/made_ticks.h"
#include "tests/recording/scratch.h"
#include "tests/support/catch.h"
#include "tests/support/text.h"

namespace jaywalk {
namespace {

std::string good_recording(const Scratch& scratch, std::uint32_t ticks) {
  Recorder recorder({scratch.path("good.jwr"), "a setup", ticks});
  for (std::uint32_t n = 0; n < ticks; ++n) record_tick(recorder, n);
  recorder.close();
  return scratch.read("good.jwr");
}

struct Reading {
  std::uint32_t good = 0;  ///< ticks that came back, each the same as written
  bool strange = false;    ///< a tick came back that nobody wrote
  std::string warning;
  std::string error;
};

Reading read_all(const std::string& file) {
  Reading reading;
  const auto read = std::make_unique<TickRecord>();
  try {
    RecordingReader reader(file);
    while (reader.next(*read)) {
      reading.strange = reading.strange || !same_bits(*read, *made_tick(reading.good));
      ++reading.good;
    }
    reading.warning = reader.warning();
  } catch (const StartupError& e) {
    reading.error = e.what();
  }
  return reading;
}

TEST_CASE("a recording cut anywhere gives what stands before the cut, and a warning") {
  const Scratch scratch;
  const std::string good = good_recording(scratch, 6);
  // Header: magic 8, version 4, setup length 4, "a setup" 7, check 4.
  const std::size_t header = 27;
  for (std::size_t size = header; size < good.size(); ++size) {
    const Reading reading = read_all(scratch.write("cut.jwr", good.substr(0, size)));
    CHECK(reading.error.empty());
    CHECK_FALSE(reading.strange);
    CHECK(holds(reading.warning, "cut short"));
  }
  for (std::size_t size = 0; size < header; ++size) {
    CHECK_FALSE(read_all(scratch.write("cut.jwr", good.substr(0, size))).error.empty());
  }
  CHECK(read_all(scratch.path("good.jwr")).warning.empty());
}

TEST_CASE("a flipped bit anywhere is noticed and its place told") {
  const Scratch scratch;
  const std::string good = good_recording(scratch, 4);
  for (std::size_t i = 0; i < good.size(); ++i) {
    std::string bad = good;
    bad[i] = static_cast<char>(bad[i] ^ (1 << (i % 8)));
    const Reading reading = read_all(scratch.write("bad.jwr", bad));
    CHECK(holds(reading.error, "bad.jwr: byte "));
    CHECK_FALSE(reading.strange);
  }
}

TEST_CASE("random damage never crashes the reader nor makes up a tick") {
  const Scratch scratch;
  const std::string good = good_recording(scratch, 20);
  std::mt19937 random(7);  // its sequence is fixed by the standard
  for (int round = 0; round < 400; ++round) {
    std::string bad = good;
    for (auto flips = 1 + random() % 20; flips > 0; --flips) bad[random() % bad.size()] ^= static_cast<char>(random());
    if (round % 3 == 0) bad.resize(random() % bad.size());
    if (round % 7 == 0) bad += good.substr(random() % good.size());
    CHECK_FALSE(read_all(scratch.write("bad.jwr", bad)).strange);
  }
}

TEST_CASE("noise, an empty file, another version and bytes behind the end mark are refused by name") {
  const Scratch scratch;
  const auto error_of = [&](const std::string& bytes) { return read_all(scratch.write("bad.jwr", bytes)).error; };
  CHECK(holds(error_of(""), "too short"));
  CHECK(holds(error_of(std::string(500, 'x')), "not a recording"));
  CHECK(holds(error_of(good_recording(scratch, 2) + "x"), "follows the end mark"));
  CHECK_FALSE(read_all(scratch.path("missing.jwr")).error.empty());
  for (const int version : {6, 8}) {
    std::string other = good_recording(scratch, 1);
    other[8] = static_cast<char>(version);
    CHECK(error_of(other) == scratch.path("bad.jwr") + ": byte 8: format version " + std::to_string(version) +
                                 ", this program reads 7 alone; replay it with the jaywalk that recorded it");
  }
}

}  // namespace
}  // namespace jaywalk
