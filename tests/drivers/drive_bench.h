#pragma once
#include <chrono>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "drivers/arcos/arcos_base.h"
#include "drivers/can/in_process_bus.h"
#include "drivers/motor/odrive.h"
#include "drivers/motor/vesc.h"
#include "hil/emulators/arcos_board.h"
#include "hil/emulators/motor_node.h"
#include "tests/drivers/drive_plant.h"
#include "tests/drivers/frames.h"
#include "tests/drivers/watched_port.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/catch.h"
#include "tests/support/text.h"

namespace jaywalk::tests {

/// Two emulated drives of any kind and the base that drives them, on a bus in this process, time moved on by hand.
/// Sides: 0 left, 1 right. Wheels: rad and rad/s, whatever the drives count in.
class DriveBench {
 public:
  virtual ~DriveBench() = default;
  [[nodiscard]] virtual WiredDrive& drives() noexcept = 0;
  [[nodiscard]] virtual double wheel_radps(std::size_t side) const = 0;  ///< the emulated motor's
  [[nodiscard]] virtual double wheel_rad(std::size_t side) const = 0;
  [[nodiscard]] virtual bool has_torque(std::size_t side) const = 0;
  virtual void pull_cable(std::size_t side) = 0;
  virtual void plug_cable(std::size_t side) = 0;
  virtual void restart(std::size_t side) = 0;
  /// A second drive with the number of the one on this side comes to the bus, and says everything before it.
  virtual void add_twin(std::size_t side) = 0;

  /// A tick is `tick` long.
  void drive(double left_radps, double right_radps, int ticks) {
    for (int k = 0; k < ticks; ++k) {
      const AllocationGuard guard;
      wheels = drives().latest();
      drives().command({clock.now(), left_radps, right_radps});
      heap_calls += guard.calls();
      wait(tick);
    }
  }
  /// What arming said, "armed" where it said yes.
  std::string armed() {
    const std::string refused = refusal_of([this] { return report = drives().arm(); });
    return refused.empty() ? "armed" : refused;
  }
  void bring_to_two_radps() {
    REQUIRE(armed() == "armed");
    drive(0.0, 0.0, 20);
    drive(2.0, 2.0, 50);
    REQUIRE(drives().trouble() == DriveTrouble::kNone);
    require_two_radps();
  }
  void require_two_radps() const {
    REQUIRE(wheel_radps(0) == Approx(2.0));
    REQUIRE(wheel_radps(1) == Approx(2.0));
  }
  void wait(Duration span) { clock.sleep_until(clock.now() + span); }
  /// Another program on the bus says this.
  void stranger_says(const CanFrame& frame) { REQUIRE(bus.port(3).send(frame)); }
  [[nodiscard]] bool is_at_rest() const { return std::fabs(wheel_radps(0)) + std::fabs(wheel_radps(1)) < 1e-9; }

  Duration tick = std::chrono::milliseconds(20);
  PlantClock clock;
  InProcessBus bus{clock, 1};
  WatchedPort port{bus.port(0), clock};
  WheelState wheels;
  std::vector<std::string> report;
  std::uint64_t heap_calls = 0;  ///< of the base, in ticks
};

/// Of one kind, as Cia402, Odrive and Vesc below name it.
template <class Kind>
class BenchOf : public DriveBench {
 public:
  using Node = typename Kind::Node;
  explicit BenchOf(const typename Kind::Setup& setup = Kind::setup())
      : left(bus.port(1), Kind::kIds[0]), right(bus.port(2), Kind::kIds[1]), base(port, clock, setup) {
    clock.plant = [this](Time now) {
      if (twin) twin->step(now);
      left.step(now), right.step(now);
    };
  }
  [[nodiscard]] Node& node(std::size_t side) { return side == 0 ? left : right; }
  [[nodiscard]] const Node& node(std::size_t side) const { return side == 0 ? left : right; }

  [[nodiscard]] WiredDrive& drives() noexcept override { return base; }
  [[nodiscard]] double wheel_radps(std::size_t side) const override { return node(side).velocity() / scale(side); }
  [[nodiscard]] double wheel_rad(std::size_t side) const override { return node(side).position() / scale(side); }
  [[nodiscard]] bool has_torque(std::size_t side) const override { return node(side).state_name() == "enabled"; }
  void pull_cable(std::size_t side) override { node(side).pull_cable(); }
  void plug_cable(std::size_t side) override { node(side).plug_cable(); }
  void restart(std::size_t side) override { node(side).restart(); }
  void add_twin(std::size_t side) override { twin.emplace(bus.port(4), Kind::kIds[side]); }

  Node left, right;
  std::optional<Node> twin;
  typename Kind::Base base;

 private:
  /// The right motor looks the other way.
  [[nodiscard]] static double scale(std::size_t side) { return side == 0 ? Kind::kPerRad : -Kind::kPerRad; }
};

/// Quick stop: 20 rad/s2; ramps: 5 rad/s2, of which a stop is owed 10/3.
struct Cia402 {
  using Node = emulators::Cia402Node;
  using Base = canopen::CanopenDriveBase;
  using Setup = canopen::DriveBaseSetup;
  static constexpr std::array<std::uint8_t, 2> kIds{5, 6};
  static constexpr double kPerRad = 1000.0;  ///< counts
  static Setup setup() { return two_axes(); }
};

/// The emulated axis ramps with 20 turns/s2: 10 rad/s2 of the wheel, of which a stop is owed 8.
struct Odrive {
  using Node = emulators::OdriveNode;
  using Base = odrive::OdriveBase;
  using Setup = odrive::BaseSetup;
  static constexpr std::array<std::uint8_t, 2> kIds{3, 4};
  static constexpr double kPerRad = 2.0;  ///< turns
  static Setup setup() {
    Setup setup;
    setup.axes = {CanAxis{3, kPerRad}, CanAxis{4, -kPerRad}};
    setup.stop = {.brake_radps2 = 8.0, .tolerance_radps = 0.5};
    return setup;
  }
};

/// The emulated motor ramps with 30000 erpm/s: 20 rad/s2 of the wheel, of which a stop is owed 15.
struct Vesc {
  using Node = emulators::VescNode;
  using Base = vesc::VescBase;
  using Setup = vesc::BaseSetup;
  static constexpr std::array<std::uint8_t, 2> kIds{23, 24};
  static constexpr double kPerRad = 25.0;  ///< electrical turns
  static Setup setup() {
    Setup setup;
    setup.axes = {CanAxis{23, kPerRad}, CanAxis{24, -kPerRad}};
    setup.stop = {.brake_radps2 = 15.0, .tolerance_radps = 0.5};
    return setup;
  }
};

/// The emulated board of a Pioneer reports every 20 ms and ramps with 1000 mm/s2: 10 rad/s2 of the wheel, of which a
/// stop is owed 8. Half a rad/s between its wheels are 10 degrees/s.
class ArcosBench : public DriveBench {
 public:
  static arcos::BaseSetup setup() {
    return {.name = "line",
            .mm_per_rad = {100.0, 100.0},
            .track_mm = 900.0 / kPi,
            .ticks_per_mm = 128,
            .motion = {2000, 800, 600, 250},
            .stop = {.brake_radps2 = 15.0, .tolerance_radps = 0.5}};
  }
  explicit ArcosBench(const arcos::BaseSetup& setup = ArcosBench::setup())
      : board(bus.port(1), 900.0 / kPi), base(port, clock, setup) {
    board.set_cycle(20);
    board.limit_ramps(2000, 800);
    clock.plant = [this](Time now) { board.step(now); };
  }

  [[nodiscard]] WiredDrive& drives() noexcept override { return base; }
  [[nodiscard]] double wheel_radps(std::size_t side) const override { return board.velocity(side) / 100.0; }
  [[nodiscard]] double wheel_rad(std::size_t side) const override { return board.position(side) / 100.0; }
  [[nodiscard]] bool has_torque(std::size_t) const override { return board.state_name() == "enabled"; }
  void pull_cable(std::size_t) override { board.pull_cable(); }
  void plug_cable(std::size_t) override { board.plug_cable(); }
  void restart(std::size_t) override { board.restart(); }
  void add_twin(std::size_t) override {}

  emulators::ArcosBoard board;
  arcos::ArcosBase base;
};

/// Answer of arming to drives after `change`.
template <class Bench, class Change>
std::string armed_after(Change change) {
  Bench bench;
  change(bench);
  return bench.armed();
}

using Cia402Bench = BenchOf<Cia402>;
using OdriveBench = BenchOf<Odrive>;
using VescBench = BenchOf<Vesc>;

}  // namespace jaywalk::tests
