#include "drivers/ros/shared_ring.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>
#include <thread>

#include "hal/types/errors.h"
#include "tests/drivers/random_bytes.h"
#include "tests/drivers/ring_path.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using ros::SharedRing;
using tests::RingPath;

namespace {

constexpr SharedRing::Shape kShape{64, 4};
using Message = std::array<std::uint64_t, 8>;

Message message_of(std::uint64_t number) {
  Message message;
  message.fill(number);
  return message;
}

void write(SharedRing& ring, std::uint64_t number) {
  const Message message = message_of(number);
  ring.write(std::as_bytes(std::span(message)));
}

SharedRing::Took read(SharedRing& ring, Message& message) {
  return ring.read(std::as_writable_bytes(std::span(message)));
}

void overwrite(const RingPath& path, std::size_t at, char byte) {
  std::fstream file(path.path(), std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(static_cast<std::streamoff>(at));
  file.put(byte);
}

/// The next whole message's number; 0 where none waits.
std::uint64_t next_of(SharedRing& ring) {
  Message message{};
  for (int tries = 0; tries < 100; ++tries) {
    const auto took = read(ring, message);
    if (took == SharedRing::Took::kNothing) return 0;
    if (took == SharedRing::Took::kMessage) return message[0];
  }
  return UINT64_MAX;
}

}  // namespace

TEST_CASE("messages come in order, whole, and none before the reader began") {
  const RingPath path;
  const auto reader = SharedRing::make(path, kShape);
  const auto early = SharedRing::find(path, kShape);
  REQUIRE(early);
  write(*early, 7);
  const auto writer = SharedRing::find(path, kShape);  // the far end was started anew
  REQUIRE(writer);
  write(*writer, 8);
  CHECK(next_of(*reader) == 7);
  CHECK(next_of(*reader) == 8);
  CHECK(next_of(*reader) == 0);
  const auto late = SharedRing::find(path, kShape);
  CHECK(next_of(*late) == 0);
  write(*writer, 9);
  CHECK(next_of(*late) == 9);
}

TEST_CASE("a reader that was held up goes on at the newest, and counts what it missed") {
  const RingPath path;
  const auto reader = SharedRing::make(path, kShape);
  const auto writer = SharedRing::find(path, kShape);
  for (std::uint64_t k = 1; k <= 10; ++k) write(*writer, k);
  CHECK(next_of(*reader) == 10);
  CHECK(reader->lost() == 9);
  write(*writer, 11);
  reader->skip();
  CHECK(next_of(*reader) == 0);
}

TEST_CASE("any bytes in the file are no message, and the next one written is read") {
  const RingPath path;
  const auto reader = SharedRing::make(path, kShape);
  const auto writer = SharedRing::find(path, kShape);
  tests::RandomBytes random(61);
  for (std::uint64_t round = 1; round <= 2000; ++round) {
    const auto size = static_cast<std::size_t>(std::filesystem::file_size(path.path()));
    for (int k = 0; k < 40; ++k) {
      const std::size_t at = random.below(size);
      overwrite(path, at, static_cast<char>(random.below(256)));
    }
    Message message{};
    for (int k = 0; k < 8; ++k) static_cast<void>(read(*reader, message));
    for (int k = 0; k < 2; ++k) write(*writer, round);  // the first may be taken for one that was read already
    bool came = false;
    for (int k = 0; k < 8 && !came; ++k)
      came = read(*reader, message) == SharedRing::Took::kMessage && message == message_of(round);
    REQUIRE(came);
  }
}

TEST_CASE("a slot that holds another message than its turn's is torn") {
  const RingPath path;
  const auto reader = SharedRing::make(path, kShape);
  const auto writer = SharedRing::find(path, kShape);
  write(*writer, 1);
  constexpr std::size_t kSlot = 8 + kShape.message_bytes;
  overwrite(path, std::filesystem::file_size(path.path()) - 3 * kSlot, 5);  // in place of 1, in the second slot of four
  Message message{};
  CHECK(read(*reader, message) == SharedRing::Took::kTorn);
  write(*writer, 2);
  CHECK(next_of(*reader) == 2);
}

TEST_CASE("two threads: what is read is whole and never older than before") {
  const RingPath path;
  const auto reader = SharedRing::make(path, kShape);
  const auto writer = SharedRing::find(path, kShape);
  constexpr std::uint64_t kLast = 200'000;
  std::thread writes([&] {
    for (std::uint64_t k = 1; k <= kLast; ++k) write(*writer, k);
  });
  std::uint64_t last = 0, broken = 0;
  while (last < kLast) {
    Message message{};
    reader->wait(std::chrono::milliseconds(20));
    if (read(*reader, message) != SharedRing::Took::kMessage) continue;
    if (message != message_of(message[0]) || message[0] <= last) ++broken;
    last = message[0];
  }
  writes.join();
  CHECK(broken == 0);
}

TEST_CASE("the file is this user's alone, goes with its maker, and replaces nothing but a ring") {
  const RingPath path;
  {
    const auto ring = SharedRing::make(path, kShape);
    struct stat is {};
    REQUIRE(::stat(path.path().c_str(), &is) == 0);
    CHECK((is.st_mode & 0777) == 0600);
    CHECK_FALSE(SharedRing::find(path, {64, 8}));  // of another shape
    CHECK(ring->is_current());
    const auto again = SharedRing::make(path, kShape);  // as after a kill
    CHECK_FALSE(ring->is_current());
    CHECK(again->is_current());
  }
  CHECK_FALSE(std::filesystem::exists(path.path()));
  CHECK_FALSE(SharedRing::find(path, kShape));
  std::ofstream(path.path()) << "a person's notes, longer than the head of a ring";
  CHECK_THROWS_AS(SharedRing::make(path, kShape), StartupError);
  CHECK(std::filesystem::file_size(path.path()) > 0);
  std::filesystem::remove(path.path());
  const RingPath other;
  const auto target = SharedRing::make(other, kShape);
  std::filesystem::create_symlink(other.path(), path.path());
  CHECK_THROWS_AS(SharedRing::make(path, kShape), StartupError);
  CHECK_FALSE(SharedRing::find(path, kShape));
  std::filesystem::remove(path.path());
  REQUIRE(::chmod(other.path().c_str(), 0660) == 0);
  CHECK_FALSE(SharedRing::find(other, kShape));
}

TEST_CASE("an alarm is seen beside the messages") {
  const RingPath path;
  const auto reader = SharedRing::make(path, kShape);
  const auto writer = SharedRing::find(path, kShape);
  CHECK(reader->alarms() == 0);
  writer->raise_alarm();
  CHECK(reader->alarms() == 1);
  CHECK(next_of(*reader) == 0);
}
