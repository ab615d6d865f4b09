// Another vendor's DDS (eProsima's Fast DDS) as the far end of jaywalk_dds, over loopback: every topic must come and be
// what its type says, and a goal that this peer publishes must be driven to.
// usage: fast_dds_peer DOMAIN GOAL_X GOAL_Y
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <map>
#include <string>
#include <thread>

using namespace eprosima::fastdds::dds;
using eprosima::fastrtps::rtps::InstanceHandle_t;
using eprosima::fastrtps::rtps::SerializedPayload_t;

namespace {

/// Bytes as they are on the wire, under a ROS 2 type's name.
class Bytes : public TopicDataType {
 public:
  explicit Bytes(const std::string& type) {
    setName(type.c_str());
    m_typeSize = 4U << 20U;
    m_isGetKeyDefined = false;
  }
  bool serialize(void* sample, SerializedPayload_t* payload) override {
    const auto& bytes = *static_cast<std::string*>(sample);
    std::memcpy(payload->data, bytes.data(), bytes.size());
    payload->length = static_cast<std::uint32_t>(bytes.size());
    payload->encapsulation = CDR_LE;
    return true;
  }
  bool deserialize(SerializedPayload_t* payload, void* sample) override {
    static_cast<std::string*>(sample)->assign(reinterpret_cast<const char*>(payload->data), payload->length);
    return true;
  }
  std::function<std::uint32_t()> getSerializedSizeProvider(void* sample) override {
    return [sample] { return static_cast<std::uint32_t>(static_cast<std::string*>(sample)->size()); };
  }
  void* createData() override { return new std::string; }
  void deleteData(void* sample) override { delete static_cast<std::string*>(sample); }
  bool getKey(void*, InstanceHandle_t*, bool) override { return false; }
};

/// Fields in CDR behind four bytes of head.
class Cdr {
 public:
  explicit Cdr(const std::string& bytes) : bytes_(bytes) {}
  template <class T>
  T number() {
    at_ = (at_ + sizeof(T) - 1) / sizeof(T) * sizeof(T);
    T value{};
    if (4 + at_ + sizeof(T) <= bytes_.size()) std::memcpy(&value, bytes_.data() + 4 + at_, sizeof(T));
    at_ += sizeof(T);
    return value;
  }
  std::string text() {
    const auto size = number<std::uint32_t>();
    const std::string out = 4 + at_ + size <= bytes_.size() && size > 0 ? bytes_.substr(4 + at_, size - 1) : "?";
    at_ += size;
    return out;
  }
  std::string header() {
    (void)number<std::int32_t>(), (void)number<std::uint32_t>();
    return text();
  }

 private:
  const std::string& bytes_;
  std::size_t at_ = 0;
};

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

std::string goal_bytes(double x, double y) {
  std::string bytes("\0\1\0\0", 4);
  const auto put = [&bytes](const auto& value, std::size_t align) {
    while ((bytes.size() - 4) % align != 0) bytes += '\0';
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  put(std::int32_t{0}, 4), put(std::uint32_t{0}, 4), put(std::uint32_t{4}, 4);
  bytes.append("map", 4);
  for (const double value : {x, y, 0.0, 0.0, 0.0, 0.0, 1.0}) put(value, 8);
  return bytes;
}

DomainParticipant* participant_on_loopback(unsigned domain) {
  DomainParticipantQos qos;
  auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
  udp->interfaceWhiteList = {"127.0.0.1"};
  qos.transport().use_builtin_transports = false;
  qos.transport().user_transports = {udp};
  eprosima::fastrtps::rtps::Locator_t peer;
  eprosima::fastrtps::rtps::IPLocator::setIPv4(peer, "127.0.0.1");
  qos.wire_protocol().builtin.initialPeersList.push_back(peer);
  return DomainParticipantFactory::get_instance()->create_participant(domain, qos);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) return 2;
  const double goal_x = std::atof(argv[2]), goal_y = std::atof(argv[3]);
  DomainParticipant* participant = participant_on_loopback(static_cast<unsigned>(std::atoi(argv[1])));
  if (participant == nullptr) return std::puts("no participant"), 1;
  Subscriber* subscriber = participant->create_subscriber(SUBSCRIBER_QOS_DEFAULT);
  HeardTopic topics[] = {{"rt/scan", "sensor_msgs::msg::dds_::LaserScan_", "laser"},
                         {"rt/odom", "nav_msgs::msg::dds_::Odometry_", "odom"},
                         {"rt/tf", "tf2_msgs::msg::dds_::TFMessage_", ""},
                         {"rt/map", "nav_msgs::msg::dds_::OccupancyGrid_", "map"},
                         {"rt/plan", "nav_msgs::msg::dds_::Path_", "map"},
                         {"rt/tracks", "visualization_msgs::msg::dds_::MarkerArray_", ""}};
  DataReaderQos reads = DATAREADER_QOS_DEFAULT;
  reads.reliability().kind = RELIABLE_RELIABILITY_QOS;
  reads.endpoint().history_memory_policy = eprosima::fastrtps::rtps::DYNAMIC_RESERVE_MEMORY_MODE;
  for (HeardTopic& topic : topics) {
    TypeSupport(new Bytes(topic.type)).register_type(participant);
    topic.reader =
        subscriber->create_datareader(participant->create_topic(topic.name, topic.type, TOPIC_QOS_DEFAULT), reads);
  }
  const std::string goal_type = "geometry_msgs::msg::dds_::PoseStamped_";
  TypeSupport(new Bytes(goal_type)).register_type(participant);
  DataWriterQos writes = DATAWRITER_QOS_DEFAULT;
  writes.endpoint().history_memory_policy = eprosima::fastrtps::rtps::DYNAMIC_RESERVE_MEMORY_MODE;
  DataWriter* goals =
      participant->create_publisher(PUBLISHER_QOS_DEFAULT)
          ->create_datawriter(participant->create_topic("rt/goal_pose", goal_type, TOPIC_QOS_DEFAULT), writes);

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
