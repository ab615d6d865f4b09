// A ROS 2 base behind jaywalk_dds, without DDS.
#include "drivers/ros/ros_base.h"

#include <algorithm>
#include <cmath>

#include "drivers/can/in_process_bus.h"
#include "tests/drivers/drive_plant.h"
#include "tests/drivers/hand_clock.h"
#include "tests/drivers/random_bytes.h"
#include "tests/drivers/ring_path.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/catch.h"
#include "tests/support/text.h"

using namespace jaywalk;
using namespace std::chrono_literals;

namespace {

constexpr double kRamp_radps2 = 20.0;

/// A base as jaywalk_dds shows it: it ramps to the wheels' speeds that it is told and says what they do.
class FarBase {
 public:
  FarBase(CanBus& bus, Clock& clock) : bus_(bus), clock_(clock) {}

  void step(Duration span) {
    const double most = kRamp_radps2 * to_seconds(span);
    ReceivedFrame received;
    while (bus_.receive(received)) {
      const auto wheel = ros::wheel_in(received.frame);
      if (wheel && !is_deaf) told_[received.frame.id - ros::kWheelOrder] = static_cast<double>(wheel->speed_radps);
      told_at_ = clock_.now();
    }
    for (std::size_t k = 0; k < 2; ++k) {
      speed_radps[k] += std::clamp(told_[k] - speed_radps[k], -most, most);
      turned_rad_[k] += speed_radps[k] * to_seconds(span);
    }
    since_ = is_mute ? 0ms : since_ + span;
    if (is_mute || since_ < period + delay_) return;
    since_ -= period;  // the next one's turn does not wait for this one
    delay_ = late * (++reports_ * 7 % 5) / 4;
    static_cast<void>(bus_.send({.id = ros::kListeners, .size = 1, .bytes = {listeners}}));
    for (std::uint32_t k = 0; k < 2; ++k)
      static_cast<void>(bus_.send(ros::to_frame(
          ros::kWheel + k,
          {static_cast<float>(speed_radps[k]),
           static_cast<std::uint32_t>(static_cast<std::int64_t>(std::llround(turned_rad_[k] / ros::kAngle_rad)))})));
  }
  [[nodiscard]] Time told_at() const { return told_at_; }

  std::array<double, 2> speed_radps{};
  std::uint8_t listeners = 1;
  bool is_mute = false, is_deaf = false;
  Duration period = 20ms, late = 0ms;

 private:
  CanBus& bus_;
  Clock& clock_;
  std::array<double, 2> told_{}, turned_rad_{};
  Duration since_{0}, delay_{0};
  int reports_ = 0;
  Time told_at_ = kNever;
};

struct Bench {
  tests::PlantClock clock;
  InProcessBus bus{clock, 1};
  FarBase far_end{bus.port(1), clock};
  ros::RosBase base;
  std::uint64_t heap_calls = 0;

  explicit Bench(bool allow_unproved = true, const DriveTimes& times = {})
      : base(bus.port(0), clock,
             {.stop = stop_limits(10.0, 0.5, 20ms, times),
              .allow_unproved = allow_unproved,
              .tick = 20ms,
              .times = times}) {
    clock.plant = [this](Time) { far_end.step(1ms); };
  }
  std::string armed() {
    std::vector<std::string> report;
    const std::string refused = refusal_of([&] { return report = base.arm(); });
    if (!refused.empty()) return refused;
    return report.size() == 2 ? report[0] : "not two lines";
  }
  WheelState drive(double left_radps, double right_radps, int ticks) {
    WheelState wheels;
    for (int k = 0; k < ticks; ++k) {
      const AllocationGuard guard;
      wheels = base.latest();
      base.command({clock.now(), left_radps, right_radps});
      heap_calls += guard.calls();
      clock.sleep_until(clock.now() + 20ms);
    }
    return wheels;
  }
  void bring_to_speed() {
    REQUIRE(armed().find("NOT PROVED") != std::string::npos);
    drive(0.0, 0.0, 60);
    const WheelState wheels = drive(2.0, 3.0, 50);
    REQUIRE(wheels.ready);
    REQUIRE(far_end.speed_radps[0] == Approx(2.0));
    REQUIRE(far_end.speed_radps[1] == Approx(3.0));
  }
};

}  // namespace

TEST_CASE("a ROS base arms only where a person takes its own timeout upon themselves, and then obeys") {
  CHECK(holds(Bench(false).armed(), "NOT PROVED; see that the base's own timeout"));
  Bench bench;
  bench.bring_to_speed();
  const WheelState wheels = bench.drive(2.0, 3.0, 50);
  CHECK(wheels.left_radps == Approx(2.0));
  CHECK(wheels.right_rad - wheels.left_rad > 0.9);
  CHECK(wheels.trouble == DriveTrouble::kNone);
  const WheelState stopped = bench.drive(0.0, 0.0, 50);
  CHECK(stopped.trouble == DriveTrouble::kNone);
  CHECK(bench.far_end.speed_radps[1] == 0.0);
  CHECK(bench.heap_calls == 0);
}

TEST_CASE("a ROS base is not armed without odometry, listeners, readings enough, or at rest") {
  Bench mute;
  mute.far_end.is_mute = true;
  CHECK(holds(mute.armed(), "/odom: no odometry comes; start the robot's ROS 2 nodes, and jaywalk_dds"));
  Bench alone;
  alone.far_end.listeners = 0;
  CHECK(holds(alone.armed(), "left wheel: 0 nodes listen to /cmd_vel, "));
  Bench slow;
  slow.far_end.period = 50ms;
  CHECK(holds(slow.armed(), "20 readings a second"));
  CHECK(holds(slow.armed(), "; write report_ms = 50 and report_late_ms = "));
  Bench too_slow;
  too_slow.far_end.period = 500ms;
  CHECK(holds(too_slow.armed(), "; have it published at least 4 times a second"));
  Bench moving;
  static_cast<void>(moving.bus.port(2).send(ros::to_frame(ros::kWheelOrder, {2.0F, 0})));
  moving.clock.sleep_until(moving.clock.now() + 200ms);
  moving.far_end.is_deaf = true;
  CHECK(holds(moving.armed(), "; see why the base moves"));
  Bench driven;
  static_cast<void>(driven.bus.port(2).send({.id = ros::kOtherMaster}));
  CHECK(holds(driven.armed(), "another program commands the drives"));
}

TEST_CASE(
    "a ROS base arms, drives and stops with reports as rare and late as its file states, and not with later ones") {
  for (const Duration period : {10ms, 20ms, 50ms, 100ms}) {
    CAPTURE(to_seconds(period));
    Bench bench(true, {.report_s = to_seconds(period), .late_s = 0.06});
    bench.far_end.period = period;
    bench.far_end.late = 60ms;
    bench.bring_to_speed();
    for (int round = 0; round < 20; ++round) {
      CHECK(bench.drive(2.0, 3.0, 50).trouble == DriveTrouble::kNone);
      const WheelState stopped = bench.drive(0.0, 0.0, 50);
      CHECK(stopped.trouble == DriveTrouble::kNone);
      CHECK(stopped.stop == StopStage::kNone);
    }
  }
  Bench later(true, {.report_s = 0.02});
  later.far_end.late = 200ms;
  CHECK(holds(later.armed(), "report_late_ms = "));
  Bench pioneer;  // whose file states nothing
  pioneer.far_end.period = 100ms;
  pioneer.far_end.late = 60ms;
  CHECK(holds(pioneer.armed(), "; write report_ms = "));
}

TEST_CASE("a ROS base that falls silent stops and stays so until a reset") {
  Bench bench;
  bench.bring_to_speed();
  bench.far_end.is_mute = true;
  bench.drive(2.0, 3.0, 10);
  CHECK(bench.base.trouble() == DriveTrouble::kDriveSilent);
  bench.drive(2.0, 3.0, 30);
  CHECK(bench.far_end.speed_radps[0] == 0.0);
  bench.far_end.is_mute = false;
  CHECK_FALSE(bench.drive(2.0, 3.0, 50).ready);
  CHECK(bench.far_end.speed_radps[0] == 0.0);
  bench.base.reset();
  bench.drive(0.0, 0.0, 120);  // proved anew
  CHECK(bench.drive(1.0, 1.0, 50).ready);
  CHECK(bench.far_end.speed_radps[0] == Approx(1.0));
}

TEST_CASE("a ROS base whose node listens no more, or which others command, stops") {
  Bench left;
  left.bring_to_speed();
  left.far_end.listeners = 0;
  left.drive(2.0, 3.0, 50);
  CHECK(left.base.trouble() == DriveTrouble::kLeftOperation);
  CHECK(left.far_end.speed_radps[1] == 0.0);
  Bench driven;
  driven.bring_to_speed();
  static_cast<void>(driven.bus.port(2).send({.id = ros::kOtherMaster}));
  driven.drive(2.0, 3.0, 50);
  CHECK(driven.base.trouble() == DriveTrouble::kForeignMaster);
  CHECK(driven.far_end.speed_radps[1] == 0.0);
}

TEST_CASE("a ROS base that does not obey zero is told nothing more") {
  Bench bench;
  bench.bring_to_speed();
  bench.far_end.is_deaf = true;
  const WheelState wheels = bench.drive(0.0, 0.0, 50);
  CHECK(wheels.trouble == DriveTrouble::kStopUnconfirmed);
  CHECK(wheels.stop == StopStage::kSilent);
  CHECK(bench.clock.now() - bench.far_end.told_at() > 300ms);
}

TEST_CASE("frames of a ROS base that are no such are dropped and counted, whatever bytes they are") {
  const tests::RingPath states, orders;
  tests::HandClock clock;
  clock.sleep_until(Time{100s});
  ros::RosBus bus({states, orders}, clock);
  const auto far_end = ros::SharedRing::find(states, ros::kBaseRing);
  REQUIRE(far_end);
  const auto say = [&](const ros::BaseMessage& message) {
    far_end->write(std::as_bytes(std::span(&message, 1)));
    ReceivedFrame received;
    return bus.receive(received) && is_valid(received.frame) && received.stamp <= clock.now();
  };
  const std::int64_t now_ns = clock.now().time_since_epoch().count();
  CHECK(say({now_ns, ros::kWheel, 8, {}}));
  CHECK_FALSE(say({now_ns + 1, ros::kWheel, 8, {}}));
  CHECK_FALSE(say({INT64_MIN, ros::kWheel, 8, {}}));
  CHECK_FALSE(say({now_ns - 11'000'000'000, ros::kWheel, 8, {}}));
  CHECK_FALSE(say({now_ns, 0, 8, {}}));
  CHECK_FALSE(say({now_ns, ros::kWheelOrder, 8, {}}));
  CHECK_FALSE(say({now_ns, ros::kWheel, 9, {}}));
  CHECK(bus.health().malformed == 6);
  ros::RosBase base(bus, clock, {.stop = stop_limits(10.0, 0.5, 20ms), .allow_unproved = true, .tick = 20ms});
  tests::RandomBytes random(5);
  for (int k = 0; k < 100'000; ++k) {
    const auto bytes = random.bytes(sizeof(ros::BaseMessage));
    ros::BaseMessage message{};
    std::copy(bytes.begin(), bytes.end(), reinterpret_cast<std::uint8_t*>(&message));
    if (k % 2 == 0) message = {now_ns, static_cast<std::uint32_t>(1 + random.below(4)), 8, message.bytes};
    far_end->write(std::as_bytes(std::span(&message, 1)));
    const WheelState wheels = base.latest();
    REQUIRE(std::isfinite(wheels.left_radps));
    REQUIRE(std::isfinite(wheels.left_rad));
    REQUIRE_FALSE(wheels.ready);
    base.command({clock.now(), 1.0, 1.0});
  }
}

TEST_CASE("a guard's brake is seen at the far end of the orders, which carry every command") {
  const tests::RingPath states, orders;
  tests::HandClock clock;
  ros::RosBus bus({states, orders}, clock);
  const auto far_end = ros::SharedRing::find(orders, ros::kBaseRing);
  REQUIRE(far_end);
  bus.brake();
  CHECK(far_end->alarms() == 1);
  CHECK(bus.send(ros::to_frame(ros::kWheelOrder, {1.5F, 0})));
  ros::BaseMessage order;
  REQUIRE(far_end->read(std::as_writable_bytes(std::span(&order, 1))) == ros::SharedRing::Took::kMessage);
  CHECK(order.id == ros::kWheelOrder);
  CHECK(order.size == 8);
}
