// Settings files with mistakes of all kinds are refused by one line or loaded: never a crash, never another exception.
#include <cstdlib>
#include <random>

#include "tests/robot/settings_bench.h"
#include "tests/support/catch.h"
#include "tests/support/text.h"

using namespace jaywalk;

namespace {

std::vector<std::string> all_pieces() {
  std::istringstream list(
      "nan|inf|-1|1e308|-9223372036854775808|99999999999999999999|\"\"|[]|[[]]|{}|true|1979-05-27|\"p3dx\"|[drive]\n|"
      "[[movers]]\n|=|.|#|\"|'''|\n||\xff");
  std::vector<std::string> pieces;
  for (std::string piece; std::getline(list, piece, '|');) pieces.push_back(piece);
  return pieces;
}

const std::vector<std::string> kPieces = all_pieces();

class Mutator {
 public:
  explicit Mutator(std::uint32_t seed) : random_(seed) {}

  [[nodiscard]] std::string mutated(std::string text) {
    for (std::size_t k = 1 + below(4); k > 0; --k) mutate(text);
    return text;
  }
  std::size_t below(std::size_t n) { return n == 0 ? 0 : random_() % n; }

 private:
  void mutate(std::string& text) {
    const std::size_t at = below(text.size()), most = text.size() - at;
    switch (below(5)) {
      case 0:
        if (!text.empty()) text[at] = static_cast<char>(random_());
        return;
      case 1: text.erase(at, below(std::min<std::size_t>(most, 30))); return;
      case 2: text.insert(at, kPieces[below(kPieces.size())]); return;
      case 3: replace_value(text, at); return;
      default: text.insert(below(text.size()), text.substr(at, below(std::min<std::size_t>(most, 60))));
    }
  }
  /// What stands behind the next equals sign.
  void replace_value(std::string& text, std::size_t at) {
    const std::size_t equals = text.find("= ", at);
    if (equals == std::string::npos) return;
    const std::size_t end = std::min(text.find('\n', equals), text.size());
    text.replace(equals + 2, end - equals - 2, kPieces[below(kPieces.size())]);
  }

  std::mt19937 random_;
};

/// Whether it is refused; anything thrown that is no StartupError ends the test.
bool refused(const SettingsKind& kind, const std::filesystem::path& file) {
  try {
    kind.load(file);
  } catch (const StartupError& error) {
    const std::string said = error.what();
    CHECK_FALSE(holds(said, "\n"));
    CHECK(holds(said, "; "));
    return true;
  }
  return false;
}

}  // namespace

TEST_CASE("mutated settings files are refused or loaded") {
  const char* wanted = std::getenv("JAYWALK_MUTATIONS");
  const int files = wanted != nullptr ? std::atoi(wanted) : 3000;
  const SettingsBench bench;
  const auto kinds = bench.kinds();
  Mutator mutator(36);
  int refusals = 0;
  for (int k = 0; k < files; ++k) {
    const SettingsKind& kind = kinds[mutator.below(kinds.size())];
    const std::string text = mutator.mutated(kind.texts[mutator.below(kind.texts.size())]);
    CAPTURE(k, text);
    refusals += refused(kind, bench.file(text)) ? 1 : 0;
  }
  CHECK(refusals > files / 4);  // both happen
  CHECK(refusals < files);
}
