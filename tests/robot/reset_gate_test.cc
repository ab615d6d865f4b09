#include "firmware/robot/operator_desk.h"
#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

class HeldPanel final : public OperatorPanel {
 public:
  [[nodiscard]] OperatorInput latest() noexcept override { return input; }
  OperatorInput input;
};

/// A drive base whose proof is over when the test says so.
class SlowDrive final : public WiredDrive {
 public:
  std::vector<std::string> arm() override { return {}; }
  [[nodiscard]] std::string inspect(std::size_t /*side*/) override { return {}; }
  [[nodiscard]] WheelState latest() noexcept override { return {}; }
  void command(const WheelCommand& /*command*/) noexcept override {}
  [[nodiscard]] DriveTrouble trouble() const noexcept override { return now; }
  [[nodiscard]] bool is_proved() const noexcept override { return proved; }
  [[nodiscard]] bool is_enabled() const noexcept override { return false; }
  void disarm() noexcept override {}
  void reset() noexcept override {
    ++resets;
    now = DriveTrouble::kNone;
  }
  DriveTrouble now = DriveTrouble::kNone;
  bool proved = true;
  int resets = 0;
};

struct Bench {
  bool passes(bool pressed, bool stop = false) {
    panel.input.reset = pressed;
    panel.input.emergency_stop = stop;
    return gate.latest().reset;
  }
  HeldPanel panel;
  SlowDrive drive;
  Permission permission;
  ResetGate gate{panel, permission, drive};
};

}  // namespace

TEST_CASE("a reset without trouble of the drives reaches the loop at once, as an edge") {
  Bench bench;
  CHECK(bench.passes(true));
  CHECK_FALSE(bench.passes(true));  // held
  CHECK(bench.drive.resets == 1);
  CHECK_FALSE(bench.passes(false));
  CHECK(bench.passes(true));
}

TEST_CASE("a reset after trouble of the drives reaches the loop when they are proved again") {
  Bench bench;
  bench.drive.now = DriveTrouble::kDriveRestarted;
  bench.drive.proved = false;
  CHECK_FALSE(bench.passes(true));
  CHECK(bench.drive.resets == 1);
  for (int k = 0; k < 50; ++k) CHECK_FALSE(bench.passes(false));
  bench.drive.proved = true;
  CHECK(bench.passes(false));
  CHECK_FALSE(bench.passes(false));
  CHECK(bench.drive.resets == 1);
}

TEST_CASE("a proof that fails is a fault: it takes the reset that waited, and says so") {
  Bench bench;
  CHECK(bench.permission.judge(Reason::kLatched | Reason::kDrive));
  bench.drive.proved = false;
  CHECK_FALSE(bench.passes(true));
  CHECK_FALSE(bench.permission.judge(Reason::kLatched));  // the trouble is forgotten
  bench.drive.now = DriveTrouble::kNotProved;
  CHECK_FALSE(bench.passes(false));
  CHECK(bench.permission.judge(Reason::kLatched | Reason::kDrive));
  CHECK_FALSE(bench.permission.judge(Reason::kLatched | Reason::kDrive));
  bench.drive.proved = true;
  CHECK_FALSE(bench.passes(false));
}

TEST_CASE("a stop while the proof runs takes the reset that waits, and so does one in the same tick") {
  Bench bench;
  bench.drive.proved = false;
  CHECK_FALSE(bench.passes(true));
  CHECK_FALSE(bench.passes(false, true));
  bench.drive.proved = true;
  CHECK_FALSE(bench.passes(false));
  CHECK_FALSE(bench.passes(true, true));
  CHECK_FALSE(bench.passes(true));
  CHECK(bench.drive.resets == 1);
}

TEST_CASE("an order to stop holds the stick until it was in its middle at rest", "[stop]") {
  Bench bench;
  const auto passes = [&](double forward) {
    bench.panel.input.stick.forward = forward;
    return bench.gate.latest().stick.forward;
  };
  CHECK(passes(1.0) == 1.0);
  bench.permission.stop();
  CHECK(passes(1.0) == 0.0);
  CHECK(passes(0.0) == 0.0);
  CHECK(passes(1.0) == 0.0);  // let go and pushed again, on the way to rest
  bench.permission.note_rest(false);
  CHECK(passes(1.0) == 0.0);
  bench.permission.note_rest(true);
  CHECK(passes(1.0) == 0.0);
  CHECK(passes(0.0) == 0.0);
  CHECK(passes(1.0) == 1.0);
}

TEST_CASE("there is no reset while a wheel is felt turning") {
  Bench bench;
  bench.gate.note_turning(true);
  CHECK_FALSE(bench.passes(true));
  bench.gate.note_turning(false);
  CHECK_FALSE(bench.passes(true));  // it was pressed too early: once more
  CHECK(bench.drive.resets == 0);
  CHECK_FALSE(bench.passes(false));
  CHECK(bench.passes(true));
}
