// Another vendor's DDS (eProsima's Fast DDS) as the far end of jaywalk_dds, over loopback: every topic must come and be
// what its type says, and a goal that this peer publishes must be driven to.
// usage: fast_dds_peer DOMAIN GOAL_X GOAL_Y
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <thread>

#include "tests/peers/fast_dds.h"

namespace {

struct HeardTopic {
  std::string name, type, frame;
  DataReader* reader = nullptr;
  int messages = 0;
};

struct Place {
  double x = 0.0, y = 0.0, heading = 0.0;
};

/// The transforms of a TFMessage one after the other: map to odom, odom to base_link.
Place robot_in_map(Cdr& in) {
  Place place;
  for (std::uint32_t left = in.number<std::uint32_t>(); left > 0; --left) {
    (void)in.header();
    (void)in.text();
    double v[7];
    for (double& value : v) value = in.number<double>();
    place = {place.x + std::cos(place.heading) * v[0] - std::sin(place.heading) * v[1],
             place.y + std::sin(place.heading) * v[0] + std::cos(place.heading) * v[1],
             place.heading + 2.0 * std::atan2(v[5], v[6])};
  }
  return place;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) return 2;
  const double goal_x = std::atof(argv[2]), goal_y = std::atof(argv[3]);
  DomainParticipant* participant = participant_on_loopback(static_cast<unsigned>(std::atoi(argv[1])));
  if (participant == nullptr) return std::puts("no participant"), 1;
  HeardTopic topics[] = {{"rt/scan", "sensor_msgs::msg::dds_::LaserScan_", "laser"},
                         {"rt/odom", "nav_msgs::msg::dds_::Odometry_", "odom"},
                         {"rt/tf", "tf2_msgs::msg::dds_::TFMessage_", ""},
                         {"rt/map", "nav_msgs::msg::dds_::OccupancyGrid_", "map"},
                         {"rt/plan", "nav_msgs::msg::dds_::Path_", "map"},
                         {"rt/tracks", "visualization_msgs::msg::dds_::MarkerArray_", ""}};
  for (HeardTopic& topic : topics) topic.reader = read_topic(participant, topic.name, topic.type, true);
  DataWriter* goals = write_topic(participant, "rt/goal_pose", "geometry_msgs::msg::dds_::PoseStamped_", true);

  int wrong = 0;
  bool all_came = false, arrived = false;
  const auto begin = std::chrono::steady_clock::now();
  std::string goal = goal_bytes(goal_x, goal_y);
  while (!arrived && std::chrono::steady_clock::now() - begin < std::chrono::seconds(120)) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    int came = 0;
    for (HeardTopic& topic : topics) {
      std::string bytes;
      SampleInfo info;
      while (topic.reader->take_next_sample(&bytes, &info) == ReturnCode_t::RETCODE_OK) {
        if (!info.valid_data) continue;
        ++topic.messages;
        Cdr in(bytes);
        if (!topic.frame.empty() && in.header() != topic.frame) ++wrong;
        if (topic.name == "rt/scan") {
          for (int k = 0; k < 7; ++k) (void)in.number<float>();
          if (in.number<std::uint32_t>() < 3) ++wrong;
        }
        if (topic.name == "rt/tf") {
          const Place robot = robot_in_map(in);
          arrived = all_came && std::hypot(robot.x - goal_x, robot.y - goal_y) < 0.4;
        }
      }
      came += topic.messages > 0 ? 1 : 0;
    }
    if (came == 6 && !all_came) goals->write(&goal);
    all_came = came == 6;
  }
  for (const HeardTopic& topic : topics) std::printf("%s %d, ", topic.name.c_str(), topic.messages);
  std::printf("%s, %d wrong\n", arrived ? "arrived at the goal" : "NOT arrived", wrong);
  return arrived && wrong == 0 ? 0 : 1;
}
