// jaywalk_dds has two jobs, each in a process of its own: what a write to the network takes never meets a tick.
// With a run's address: passes its topics on to ROS 2 and other programs on DDS. With a robot file: passes its ROS 2
// devices on to the robot's program. With --goals either takes goals, and the place where the robot is.
#include <CLI/CLI.hpp>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <map>
#include <thread>

#include "apps/dds/dds_topics.h"
#include "apps/dds/foxglove_client.h"
#include "apps/dds/robot_bridge.h"
#include "firmware/robot/control_socket.h"
#include "hal/types/errors.h"

namespace {
using namespace jaywalk;

constexpr auto kWait = std::chrono::milliseconds(10);  // longest that a goal waits for its turn
constexpr auto kOrderPeriod = std::chrono::milliseconds(50);

std::atomic<bool> ends{false};  // threads and a signal look at it

struct Options {
  std::string from, fingerprint, space, control_socket;
  std::uint32_t domain = 0;
  bool takes_goals = false;
};

void greet(const Options& options) {
  std::printf("jaywalk_dds: %s on DDS domain %u; %s\n", options.from.c_str(), options.domain,
              options.takes_goals ? "any program there can set goals and say where the robot is" : "takes no goals");
  std::fflush(stdout);
}

void pass_run_on(const Options& options) {
  dds::DdsTopics topics(options.domain, options.takes_goals, options.space);
  dds::FoxgloveClient live(options.from, options.fingerprint);
  std::map<std::string, bool> refused;
  greet(options);
  while (!ends) {
    if (const auto message = live.next(kWait); message && !topics.publish(message->topic, message->bytes)) {
      if (!std::exchange(refused[message->topic], true))
        std::fprintf(stderr, "jaywalk_dds: rt%s: a message was not sent: its bytes do not fit its type\n",
                     message->topic.c_str());
    }
    if (const auto order = topics.take_order()) live.publish(*order);
  }
}

/// Returns the run's answer.
std::string say(const std::filesystem::path& socket, const dds::PoseOrder& order) {
  const std::string words = words_of(order);
  if (words.empty()) return "refused: no pose in the frame map\n";
  try {
    return ask(socket, words);
  } catch (const StartupError& error) {
    return std::string(error.what()) + "\n";
  }
}

void pass_orders(dds::PoseReader poses, const std::filesystem::path& socket) {
  for (; !ends; std::this_thread::sleep_for(kOrderPeriod)) {
    const auto order = poses.take();
    if (!order) continue;
    std::printf("jaywalk_dds: %s: %s", order->is_place ? "place" : "goal", say(socket, *order).c_str());
    std::fflush(stdout);
  }
}

void pass_robot_on(const Options& options) {
  const RobotFile robot = load_robot_file(options.from);
  std::filesystem::path socket = options.control_socket;
  if (socket.empty()) socket = robot.control_socket.empty() ? default_control_socket() : robot.control_socket;
  dds::RobotBridge bridge(robot, options.domain);
  greet(options);
  std::thread orders, out([&] {
    while (!ends) bridge.pass_out(kWait);
  });
  if (options.takes_goals) orders = std::thread([poses = bridge.poses(), &socket] { pass_orders(poses, socket); });
  while (!ends) bridge.pass_in(kWait);
  out.join();
  if (orders.joinable()) orders.join();
  bridge.stop();
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app{
      "jaywalk_dds: a run's topics on DDS (rt/scan, rt/odom, rt/tf, rt/map, rt/plan, rt/tracks, rt/joint_states), or "
      "a robot's laser and base from it; with --goals, goals from rt/goal_pose, its place from rt/initialpose. Not yet "
      "tried with ROS 2 "
      "itself"};
  app.add_option("from", options.from,
                 "What a run with --view prints, http://127.0.0.1:PORT/ with its token; or ROBOT.toml with kind = "
                 "\"dds\" in [laser] or [drive]")
      ->required();
  app.add_flag("--goals", options.takes_goals,
               "Take goals and places: DDS asks nobody who he is, so that any program in the domain can send the robot "
               "anywhere");
  app.add_option("--fingerprint", options.fingerprint,
                 "Of the certificate behind an https:// address, as the run prints it: AB:CD:...");
  app.add_option("--namespace", options.space,
                 "Before a run's topics, /jaywalk say: where the robot has topics of these names itself")
      ->check([](const std::string& space) { return space.front() == '/' ? "" : "begins with a /"; });
  app.add_option("--socket", options.control_socket, "Of the run that goals go to, with ROBOT.toml");
  app.add_option("--domain", options.domain, "DDS domain; ROS 2's ROS_DOMAIN_ID")
      ->envname("ROS_DOMAIN_ID")
      ->check(CLI::Range(0, 232))
      ->capture_default_str();
  app.footer(
      "Examples:\n  jaywalk_dds http://127.0.0.1:8080/\n  jaywalk_dds robot.toml\nExit code: 0: ended by a signal, 2: "
      "bad input, or the run has ended");
  CLI11_PARSE(app, argc, argv);
  std::signal(SIGINT, [](int) { ends = true; });
  std::signal(SIGTERM, [](int) { ends = true; });
  try {
    options.from.ends_with(".toml") ? pass_robot_on(options) : pass_run_on(options);
  } catch (const StartupError& error) {
    std::fprintf(stderr, "jaywalk_dds: %s\n", error.what());
    return 2;
  }
  return 0;
}
