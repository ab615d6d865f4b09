#include "firmware/recording/recorder.h"

#include <memory>
#include <thread>
#include <vector>

#include "hal/types/errors.h"
#include "tests/recording/made_ticks.h"
#include "tests/recording/scratch.h"
#include "tests/support/catch.h"

namespace jaywalk {
namespace {

TEST_CASE("every field of every tick comes back bit for bit, NaN payloads too") {
  const Scratch scratch;
  const std::string file = scratch.path("recording.jwr");
  {
    Recorder recorder({file, "setup\nof two lines", 8});
    for (std::uint32_t n = 0; n < 100; ++n) {
      record_tick(recorder, n);
      REQUIRE(recorder.drain());
    }
    REQUIRE(recorder.close());
  }
  RecordingReader reader(file);
  CHECK(reader.setup() == "setup\nof two lines");
  const auto read = std::make_unique<TickRecord>();
  for (std::uint32_t n = 0; n < 100; ++n) {
    REQUIRE(reader.next(*read));
    CHECK(same_bits(*read, *made_tick(n)));
    CHECK(reader.lost_before() == 0);
    if (n == 49) CHECK(reader.share_read() == Approx(0.5).margin(0.02));
  }
  CHECK(reader.share_read() == Approx(1.0).margin(0.01));
  CHECK_FALSE(reader.next(*read));
  CHECK(reader.warning().empty());
}

TEST_CASE("no more than 0.1 s of ticks wait for the disk: so much is lost when the program is killed") {
  const Scratch scratch;
  const std::string file = scratch.path("recording.jwr");
  Recorder recorder({file, "setup", 8});
  const auto on_disk = [&file] {
    RecordingReader reader(file);
    const auto read = std::make_unique<TickRecord>();
    std::uint32_t ticks = 0;
    while (reader.next(*read)) ++ticks;
    return ticks;
  };
  for (std::uint32_t n = 0; n < 60; ++n) {
    record_tick(recorder, n);
    REQUIRE(recorder.drain());
    CHECK(n + 1 - on_disk() <= 5);  // of 20 ms each
  }
}

TEST_CASE("numbers lie little endian in the file") {
  // An entry begins with how many records were lost before it, whose lowest byte comes first. The left wheel's position
  // stands behind that (8), two flags, the tick's and the wheels' time (8 each) and the wheels' sequence (4); 1.0 is
  // 3FF0000000000000h.
  const auto record = made_tick(0);
  record->wheels.left_rad = 1.0;
  const std::vector<unsigned char> bytes = entry_of(*record, 0x1122334455667788);
  REQUIRE(bytes.size() > 38);
  const auto eight_from = [&](std::ptrdiff_t at) {
    return std::vector<unsigned char>(bytes.begin() + at, bytes.begin() + at + 8);
  };
  CHECK(eight_from(0) == std::vector<unsigned char>{0x88, 0x77, 0x66, 0x55, 0x44, 0x33, 0x22, 0x11});
  CHECK(eight_from(30) == std::vector<unsigned char>{0, 0, 0, 0, 0, 0, 0xF0, 0x3F});
}

TEST_CASE("a scan is written once, however many ticks see it") {
  // Both ticks hold scan 1 of 5 beams and fix 1 without movers, and no path. The first entry has, beyond the
  // second: the scan (stamp 8, sequence 4, four floats 16, two durations 16, count 4, 5 ranges 20:
  // 68) and the fix (stamp 8, sequence 4, flag 1, pose 24, three deviations 24, count 4: 65).
  TickEncoder encoder;
  std::vector<unsigned char> bytes(kMaxEntryBytes);
  const std::size_t first = encoder.encode(*made_tick(0), 0, bytes);
  const std::size_t second = encoder.encode(*made_tick(2), 0, bytes);
  CHECK(first - second == 68 + 65);
}

TEST_CASE("the largest record that there can be fits an entry") {
  const auto record = made_tick(0);
  record->scan.beam_count = kMaxBeams;
  while (record->fix.movers.push_back({})) {
  }
  record->path.stamp = Time{Duration{1}};
  for (std::int32_t k = 1; record->path.points.push_back({2'147'483'647 * k, -2'147'483'647 * k}); k = -k) {
  }
  const std::vector<unsigned char> bytes = entry_of(*record);
  CHECK(bytes.size() < kMaxEntryBytes);
  const auto read = record_of(bytes);
  REQUIRE(read);
  CHECK(same_bits(*read, *record));
}

TEST_CASE("a path takes two bytes a point where it is smooth, and comes back in whole millimetres") {
  // 100 mm a step along x; y bends by 1 mm a step. After the first two points each number is a byte.
  Plan plan;
  plan.stamp = Time{Duration{7}};
  for (int k = 0; k < 200; ++k) static_cast<void>(plan.path.push_back({0.1 * k + 0.0004, 1e-3 * 0.5 * k * (k - 1)}));
  const auto record = made_tick(0);
  const std::size_t without = entry_of(*record).size();
  keep_path(plan, record->path);
  const std::vector<unsigned char> with = entry_of(*record);
  CHECK(with.size() - without == 8 + 2 * 200 + 1);  // the stamp; the first step of x, 100, takes two bytes
  const auto read = record_of(with);
  REQUIRE(read);
  CHECK(same_path(read->path, record->path));
  CHECK(read->path.points[3] == PointMm{300, 3});
  CHECK(in_metres(read->path.points[3]).x == 0.3);
}

TEST_CASE("a point beyond what a millimetre of 32 bits can say is no path") {
  std::vector<unsigned char> bytes = entry_of(*made_tick(1));
  REQUIRE(record_of(bytes));
  // The last point's x, behind 287 bytes, the count and the stamp: the bend from 2,147,483,647 by two and a half times
  // as much back. One more in its highest seven bits carries it beyond.
  std::size_t at = 287 + 4 + 8;
  for (int numbers = 8; numbers > 0; ++at) numbers -= bytes[at] < 0x80 ? 1 : 0;
  while (bytes[at] >= 0x80) ++at;
  bytes[at] = static_cast<unsigned char>(bytes[at] + 1);
  CHECK_FALSE(record_of(bytes));
}

TEST_CASE("a full ring drops the tick, counts it, and the next one kept tells") {
  // Room for 4: ticks 0 to 3 are kept, 4 to 6 dropped, 7 is kept after a drain and says 3.
  const Scratch scratch;
  const std::string file = scratch.path("recording.jwr");
  Recorder recorder({file, "", 4});
  for (std::uint32_t n = 0; n < 7; ++n) record_tick(recorder, n);
  CHECK(recorder.dropped() == 3);
  CHECK(recorder.is_losing());  // the draining thread hangs: the tick knows
  REQUIRE(recorder.drain());
  record_tick(recorder, 7);
  CHECK_FALSE(recorder.is_losing());
  REQUIRE(recorder.close());

  RecordingReader reader(file);
  const auto read = std::make_unique<TickRecord>();
  for (const std::uint32_t n : {0U, 1U, 2U, 3U, 7U}) {
    REQUIRE(reader.next(*read));
    CHECK(same_bits(*read, *made_tick(n)));
    CHECK(reader.lost_before() == (n == 7 ? 3U : 0U));
  }
  CHECK_FALSE(reader.next(*read));
}

TEST_CASE("a record begins empty, whatever its slot held before") {
  Recorder recorder({"", "", 1});
  record_tick(recorder, 4);
  CHECK(recorder.drain());
  const TickRecord& fresh = recorder.begin(Time{Duration{9}});
  auto expected = std::make_unique<TickRecord>();
  expected->now = Time{Duration{9}};
  CHECK(same_bits(fresh, *expected));
}

TEST_CASE("another thread drains while the loop records, and no tick is torn") {
  const Scratch scratch;
  const std::string file = scratch.path("recording.jwr");
  constexpr std::uint32_t kTicks = 20'000;
  Recorder recorder({file, "", 16});
  std::atomic<bool> done{false};
  std::thread drain([&] {
    while (!done.load()) recorder.drain();
  });
  for (std::uint32_t n = 0; n < kTicks; ++n) record_tick(recorder, n);
  done = true;
  drain.join();
  REQUIRE(recorder.close());

  RecordingReader reader(file);
  const auto read = std::make_unique<TickRecord>();
  std::uint64_t n = 0;
  std::uint64_t kept = 0;
  bool all_whole = true;
  while (reader.next(*read)) {
    n += reader.lost_before();
    all_whole = all_whole && same_bits(*read, *made_tick(static_cast<std::uint32_t>(n)));
    ++n;
    ++kept;
  }
  CHECK(all_whole);
  CHECK(kept + recorder.dropped() == kTicks);
}

TEST_CASE("a recording that cannot be written is refused at start") {
  CHECK_THROWS_AS(Recorder({"/nowhere/at/all/recording.jwr", "", 4}), StartupError);
}

}  // namespace
}  // namespace jaywalk
