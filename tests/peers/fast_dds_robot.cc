// Another vendor's DDS (eProsima's Fast DDS) plays a ROS 2 robot over loopback: a base with a timeout of its own that
// obeys rt/cmd_vel and publishes rt/odom 50 times a second, and a laser with rt/scan 10 times a second, in a room of
// 12 m x 8 m with three pillars. It says each 100 ms where it stands, and what happens to it.
// usage: fast_dds_robot DOMAIN reliable|best-effort plain|stamped [LOSS [TURNED]]   (share of messages it loses, both
// ways; its laser's heading on it, rad)
// Orders on standard input: "goal X Y", "here X Y HEADING", "mute odom", "mute scan", "speak", "rival" (another node
// commands the base), "end"
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <random>
#include <sstream>
#include <thread>

#include "tests/peers/fast_dds.h"

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kLeft = -2.0, kRight = 10.0, kBottom = -4.0, kTop = 4.0;
constexpr double kPillars[][3] = {{3.0, 0.6, 0.3}, {5.5, -1.0, 0.3}, {7.0, 2.0, 0.4}};
constexpr double kBody_m = 0.3, kTimeout_s = 0.5, kStep_s = 0.01;
constexpr double kAccel_mps2 = 1.5, kTurnAccel_radps2 = 5.0;
constexpr int kBeams = 270;  // 269 steps of a degree

struct Base {
  double x = 0.0, y = 0.0, heading = 0.0, v = 0.0, w = 0.0, wanted_v = 0.0, wanted_w = 0.0, silent_s = 1e9,
         turned = 0.0;

  void step() {
    silent_s += kStep_s;
    if (silent_s > kTimeout_s) wanted_v = wanted_w = 0.0;
    v += std::clamp(wanted_v - v, -kAccel_mps2 * kStep_s, kAccel_mps2 * kStep_s);
    w += std::clamp(wanted_w - w, -kTurnAccel_radps2 * kStep_s, kTurnAccel_radps2 * kStep_s);
    x += v * std::cos(heading) * kStep_s, y += v * std::sin(heading) * kStep_s;
    heading = std::remainder(heading + w * kStep_s, 2.0 * kPi);
  }
  [[nodiscard]] double clearance() const {
    double least = std::min({x - kLeft, kRight - x, y - kBottom, kTop - y});
    for (const auto& p : kPillars) least = std::min(least, std::hypot(x - p[0], y - p[1]) - p[2]);
    return least - kBody_m;
  }
  [[nodiscard]] float range(double angle) const {
    const double c = std::cos(heading + turned + angle), s = std::sin(heading + turned + angle);
    double least = 1e9;
    if (std::fabs(c) > 1e-9) least = std::min(least, ((c > 0 ? kRight : kLeft) - x) / c);
    if (std::fabs(s) > 1e-9) least = std::min(least, ((s > 0 ? kTop : kBottom) - y) / s);
    for (const auto& p : kPillars) {
      const double dx = p[0] - x, dy = p[1] - y, along = dx * c + dy * s, off2 = dx * dx + dy * dy - along * along;
      if (along > 0.0 && off2 < p[2] * p[2]) least = std::min(least, along - std::sqrt(p[2] * p[2] - off2));
    }
    return static_cast<float>(least);
  }
};

std::int64_t unix_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::system_clock::now().time_since_epoch())
      .count();
}

std::string odometry_bytes(const Base& base) {
  CdrOut out;
  out.header(unix_ns(), "odom").text("base_link");
  const double pose[] = {base.x, base.y, 0.0, 0.0, 0.0, std::sin(0.5 * base.heading), std::cos(0.5 * base.heading)};
  for (const double value : pose) out.number(value);
  for (int k = 0; k < 36; ++k) out.number(0.0);
  for (const double value : {base.v, 0.0, 0.0, 0.0, 0.0, base.w}) out.number(value);
  for (int k = 0; k < 36; ++k) out.number(0.0);
  return out.bytes();
}

std::string scan_bytes(const Base& base) {
  const double first = -134.5 * kPi / 180.0, step = kPi / 180.0;
  CdrOut out;
  out.header(unix_ns(), "laser")
      .number(static_cast<float>(first))
      .number(static_cast<float>(first + step * (kBeams - 1)));
  out.number(static_cast<float>(step)).number(0.0F).number(0.1F).number(0.05F).number(25.0F);
  out.number(static_cast<std::uint32_t>(kBeams));
  for (int k = 0; k < kBeams; ++k) out.number(base.range(first + step * k));
  out.number(std::uint32_t{0});
  return out.bytes();
}

/// Lines of standard input that are there.
std::string next_order() {
  static std::string text;
  pollfd in{STDIN_FILENO, POLLIN, 0};
  char part[256];
  if (::poll(&in, 1, 0) > 0 && (in.revents & POLLIN) != 0) {
    const ssize_t got = ::read(STDIN_FILENO, part, sizeof part);
    if (got > 0) text.append(part, static_cast<std::size_t>(got));
  }
  const std::size_t end = text.find('\n');
  if (end == std::string::npos) return "";
  std::string order = text.substr(0, end);
  text.erase(0, end + 1);
  return order;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) return 2;
  const bool reliable = std::string(argv[2]) == "reliable", stamped = std::string(argv[3]) == "stamped";
  std::bernoulli_distribution lost(argc > 4 ? std::atof(argv[4]) : 0.0);
  std::mt19937 random(61);
  DomainParticipant* participant = participant_on_loopback(static_cast<unsigned>(std::atoi(argv[1])));
  if (participant == nullptr) return std::puts("no participant"), 1;
  const std::string twist = stamped ? "geometry_msgs::msg::dds_::TwistStamped_" : "geometry_msgs::msg::dds_::Twist_";
  DataWriter* odometry = write_topic(participant, "rt/odom", "nav_msgs::msg::dds_::Odometry_", reliable);
  DataWriter* scans = write_topic(participant, "rt/scan", "sensor_msgs::msg::dds_::LaserScan_", reliable);
  DataWriter* goals = write_topic(participant, "rt/goal_pose", "geometry_msgs::msg::dds_::PoseStamped_", true);
  DataWriter* places =
      write_topic(participant, "rt/initialpose", "geometry_msgs::msg::dds_::PoseWithCovarianceStamped_", true);
  DataReader* commands = read_topic(participant, "rt/cmd_vel", twist, reliable);
  DomainParticipant* other = nullptr;
  DataWriter* rival = nullptr;

  Base base;
  base.turned = argc > 5 ? std::atof(argv[5]) : 0.0;
  bool mute_odom = false, mute_scan = false;
  double least_clearance = 1e9;
  auto due = std::chrono::steady_clock::now();
  for (int step = 0;; ++step) {
    std::this_thread::sleep_until(due += std::chrono::milliseconds(10));
    std::string bytes;
    SampleInfo info;
    while (commands->take_next_sample(&bytes, &info) == ReturnCode_t::RETCODE_OK) {
      if (!info.valid_data || lost(random)) continue;
      Cdr in(bytes);
      if (stamped) (void)in.header();
      base.wanted_v = in.number<double>();
      for (int k = 0; k < 4; ++k) (void)in.number<double>();
      base.wanted_w = in.number<double>();
      base.silent_s = 0.0;
    }
    base.step();
    least_clearance = std::min(least_clearance, base.clearance());
    if (step % 2 == 0 && !mute_odom && !lost(random)) odometry->write(&(bytes = odometry_bytes(base)));
    if (step % 10 == 0 && !mute_scan && !lost(random)) scans->write(&(bytes = scan_bytes(base)));
    if (rival != nullptr && step % 10 == 0)
      rival->write(&(bytes = CdrOut().bytes() + std::string(stamped ? 64 : 48, '\0')));
    if (step % 10 == 0)
      std::printf("at %.3f %.3f %.3f v %.3f clear %.3f\n", base.x, base.y, base.heading, base.v, least_clearance);
    std::fflush(stdout);
    const std::string order = next_order();
    std::istringstream words(order);
    std::string verb, what;
    double x = 0.0, y = 0.0, heading = 0.0;
    words >> verb;
    if (verb == "goal" && words >> x >> y) goals->write(&(bytes = goal_bytes(x, y)));
    if (verb == "here" && words >> x >> y >> heading) {
      CdrOut out;
      out.bytes() = goal_bytes(x, y, heading);
      for (int k = 0; k < 36; ++k) out.number(0.0);
      places->write(&out.bytes());
    }
    if (verb == "mute" && words >> what) (what == "odom" ? mute_odom : mute_scan) = true;
    if (verb == "speak") mute_odom = mute_scan = false;
    if (verb == "rival") {
      other = participant_on_loopback(static_cast<unsigned>(std::atoi(argv[1])));
      rival = write_topic(other, "rt/cmd_vel", twist, true);
    }
    if (verb == "end") return 0;
  }
}
