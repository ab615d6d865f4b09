// jaywalk_dds: passes a run's topics on to ROS 2 and other programs on DDS, and, with --goals, their goals to the run.
// A process of its own: what a write to the network takes never meets a tick.
#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <map>

#include "apps/dds/dds_topics.h"
#include "apps/dds/foxglove_client.h"
#include "hal/types/errors.h"

namespace {

using namespace jaywalk;

constexpr auto kWait = std::chrono::milliseconds(10);  // longest that a goal waits for its turn

volatile std::sig_atomic_t ends = 0;

struct Options {
  std::string url, fingerprint;
  std::uint32_t domain = 0;
  bool takes_goals = false;
};

void run(const Options& options) {
  dds::DdsTopics topics(options.domain, options.takes_goals);
  dds::FoxgloveClient live(options.url, options.fingerprint, dds::DdsTopics::topics());
  std::map<std::string, bool> refused;
  std::printf("jaywalk_dds: %s on DDS domain %u; %s\n", options.url.c_str(), options.domain,
              options.takes_goals ? "any program there can set goals" : "takes no goals");
  std::fflush(stdout);
  while (ends == 0) {
    if (const auto message = live.next(kWait); message && !topics.publish(message->topic, message->bytes)) {
      if (!std::exchange(refused[message->topic], true))
        std::fprintf(stderr, "jaywalk_dds: rt%s: a message was not sent: its bytes do not fit its type\n",
                     message->topic.c_str());
    }
    if (const auto goal = topics.take_goal()) live.publish_goal(*goal);
  }
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app{
      "jaywalk_dds: a run's topics on DDS (rt/scan, rt/odom, rt/tf, rt/map, rt/plan, rt/tracks), and, with --goals, "
      "goals from rt/goal_pose"};
  app.add_option("url", options.url, "What a run with --view prints: http://127.0.0.1:PORT/, with its token")
      ->required();
  app.add_flag("--goals", options.takes_goals,
               "Take goals: DDS asks nobody who he is, so that any program in the domain can send the robot anywhere");
  app.add_option("--fingerprint", options.fingerprint,
                 "Of the certificate behind an https:// address, as the run prints it: AB:CD:...");
  app.add_option("--domain", options.domain, "DDS domain; ROS 2's ROS_DOMAIN_ID")
      ->check(CLI::Range(0, 232))
      ->capture_default_str();
  app.footer(
      "Example:\n  jaywalk_dds http://127.0.0.1:8080/\nExit code: 0: ended by a signal, 2: bad input, or the run has "
      "ended");
  CLI11_PARSE(app, argc, argv);
  std::signal(SIGINT, [](int) { ends = 1; });
  std::signal(SIGTERM, [](int) { ends = 1; });
  try {
    run(options);
  } catch (const StartupError& error) {
    std::fprintf(stderr, "jaywalk_dds: %s\n", error.what());
    return 2;
  }
  return 0;
}
