#include "apps/jaywalk/progress.h"

#include <pty.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <iostream>
#include <memory>
#include <string>

#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

struct Close {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, Close>;

/// A terminal and whoever looks at it; none, and "skipped", where there are no pseudo terminals.
class Terminal {
 public:
  Terminal() {
    int master = -1, slave = -1;
    if (openpty(&master, &slave, nullptr, nullptr, nullptr) != 0) {
      std::cout << "skipped: no pseudo terminal can be opened\n";
      return;
    }
    looker_ = master;
    program_.reset(fdopen(slave, "w"));
  }
  ~Terminal() { ::close(looker_); }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  [[nodiscard]] std::FILE* program() const { return program_.get(); }
  /// What was written since it was last asked; one read, of something that is there.
  [[nodiscard]] std::string seen() const {
    std::array<char, 1000> bytes{};
    const ssize_t count = ::read(looker_, bytes.data(), bytes.size());
    return {bytes.data(), count > 0 ? static_cast<std::size_t>(count) : 0};
  }

 private:
  int looker_ = -1;
  File program_;
};

}  // namespace

TEST_CASE("a bar on a terminal shows the share and the words, and is gone when something else is to be printed") {
  const Terminal terminal;
  if (terminal.program() == nullptr) return;
  Progress progress(terminal.program());
  progress.show(0.5, "12 s");
  CHECK(terminal.seen() == "\r[###############               ] 12 s" + std::string(39, ' '));
  progress.make_way();
  CHECK(terminal.seen() == "\r" + std::string(76, ' ') + "\r");
}

TEST_CASE("a bar is drawn over no sooner than it is due again") {
  const Terminal terminal;
  if (terminal.program() == nullptr) return;
  Progress progress(terminal.program(), std::chrono::hours(1));
  CHECK(progress.is_due());
  progress.show(0.1, "first");
  CHECK_FALSE(progress.is_due());
  progress.show(0.2, "second");
  CHECK(terminal.seen().find("second") == std::string::npos);
  Progress always(terminal.program(), std::chrono::milliseconds(0));
  always.show(0.1, "first");
  CHECK(always.is_due());
}

TEST_CASE("a bar holds any share and any words to its line") {
  const Terminal terminal;
  if (terminal.program() == nullptr) return;
  const double share = GENERATE(-1.0, 0.0, 1.0, 7.0, std::nan(""), HUGE_VAL, -HUGE_VAL);
  Progress progress(terminal.program());
  progress.show(share, std::string(500, 'x'));
  const std::string seen = terminal.seen();
  CHECK(seen.size() == 1 + 76);
  CHECK(seen.find('#') == (share >= 1.0 ? 2 : std::string::npos));
}

TEST_CASE("where nobody looks no bar is written") {
  const File file(std::tmpfile());
  REQUIRE(file != nullptr);
  {
    Progress progress(file.get());
    CHECK_FALSE(progress.is_due());
    progress.show(0.5, "12 s");
    progress.make_way();
  }
  CHECK(std::ftell(file.get()) == 0);
}
