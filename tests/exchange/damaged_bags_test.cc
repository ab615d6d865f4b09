// Recordings that were cut or changed anywhere: refused in words, or read where the format cannot tell.
#include <random>

#include "tests/exchange/made_bags.h"
#include "tests/recording/scratch.h"
#include "tests/support/catch.h"
#include "tests/support/text.h"

namespace jaywalk::exchange {
namespace {

using namespace tests;

/// Why it was refused, or what of it was left out; empty where it was read.
std::string refusal(const std::string& file) {
  std::string told;
  const std::string refused = refusal_of([&] { return told = load_bag(file, {}).complaint(); });
  return holds(told, "cut short") ? told : refused;
}

struct Format {
  std::string name, bytes;
};

std::vector<Format> formats(const Scratch& scratch) {
  write_sqlite(scratch.path("whole.db3"), made_drive(false), false);
  return {{"a.mcap", mcap_of(made_drive(false), "")},
          {"b.mcap", mcap_of(made_drive(false), "zstd")},
          {"c.mcap", mcap_of(made_drive(false), "lz4")},
          {"a.bag", ros1_bag_of(made_drive(true), "")},
          {"b.bag", ros1_bag_of(made_drive(true), "bz2")},
          {"c.bag", ros1_bag_of(made_drive(true), "lz4")},
          {"a.db3", scratch.read("whole.db3")},
          {"d.mcap", mcap_of(made_drive(false), "", true)},
          {"e.mcap", mcap_of(made_foxglove_drive(), "zstd")},
          {"d.bag", ros1_bag_of(made_drive(true), "", ros1_index(9, 180) + std::string(50, '\x01'))}};
}

TEST_CASE("a recording that was cut anywhere is refused with a remedy, or told, with the file's name") {
  const Scratch scratch;
  std::mt19937 random(1);
  for (const auto& [name, bytes] : formats(scratch)) {
    CHECK(refusal(scratch.write(name, bytes)).empty());
    for (int k = 0; k < 60; ++k) {
      const std::string said = refusal(scratch.write(name, bytes.substr(0, random() % bytes.size())));
      INFO(name << ": " << said);
      CHECK(holds(said, name));
      CHECK((holds(said, "; ") || holds(said, "messages before count")));
    }
  }
}

TEST_CASE("a byte that changed anywhere in an MCAP file's data is noticed") {
  const Scratch scratch;
  std::mt19937 random(2);
  for (const std::string method : {"", "zstd", "lz4"}) {
    const std::string good = mcap_of(made_drive(false), method);
    for (int k = 0; k < 300; ++k) {
      std::string bad = good;
      const std::size_t at = random() % (bad.size() - 50);  // the end mark, the footer and the magic follow
      bad[at] = static_cast<char>(bad[at] ^ (1 << (random() % 8)));
      INFO(method << " byte " << at);
      CHECK_FALSE(refusal(scratch.write("bad.mcap", bad)).empty());
    }
  }
}

TEST_CASE("recordings full of random changes are refused in words or read, and nothing worse happens") {
  const Scratch scratch;
  std::mt19937 random(3);
  for (const auto& [name, bytes] : formats(scratch)) {
    for (int k = 0; k < 300; ++k) {
      std::string bad = bytes;
      for (std::size_t changes = 1 + random() % 8; changes > 0; --changes)
        bad[random() % bad.size()] = static_cast<char>(random() % 3 == 0 ? 0xFF : random());
      const std::string said = refusal(scratch.write(name, bad));
      CHECK((said.empty() || holds(said, name)));
    }
  }
}

TEST_CASE("lengths that no file has are refused, and not asked of memory") {
  const Scratch scratch;
  std::string chunk = mcap_of(made_drive(false), "");
  const std::size_t at = chunk.find('\6', 30);  // the chunk's record: its length, two times, then its unpacked size
  for (std::size_t k = 0; k < 8; ++k) chunk[at + 9 + 16 + k] = '\x7F';
  CHECK(holds(refusal(scratch.write("a.mcap", chunk)), "a chunk of 9187201950435737471 bytes"));
}

}  // namespace
}  // namespace jaywalk::exchange
