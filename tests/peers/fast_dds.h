#pragma once
// What peers on Fast DDS share: messages as bytes under ROS 2 types' names, over loopback alone.
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <functional>
#include <memory>
#include <string>

using namespace eprosima::fastdds::dds;
using eprosima::fastrtps::rtps::InstanceHandle_t;
using eprosima::fastrtps::rtps::SerializedPayload_t;

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

/// The same the other way.
class CdrOut {
 public:
  template <class T>
  CdrOut& number(T value) {
    while ((bytes_.size() - 4) % sizeof(T) != 0) bytes_ += '\0';
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
    return *this;
  }
  CdrOut& text(const std::string& value) {
    number(static_cast<std::uint32_t>(value.size() + 1));
    bytes_.append(value.c_str(), value.size() + 1);
    return *this;
  }
  CdrOut& header(std::int64_t stamp_ns, const std::string& frame) {
    number(static_cast<std::int32_t>(stamp_ns / 1000000000)).number(static_cast<std::uint32_t>(stamp_ns % 1000000000));
    return text(frame);
  }
  std::string& bytes() { return bytes_; }

 private:
  std::string bytes_{"\0\1\0\0", 4};
};

inline std::string goal_bytes(double x, double y, double heading = 0.0) {
  CdrOut out;
  out.header(0, "map");
  for (const double value : {x, y, 0.0, 0.0, 0.0, std::sin(0.5 * heading), std::cos(0.5 * heading)}) out.number(value);
  return out.bytes();
}

inline DomainParticipant* participant_on_loopback(unsigned domain) {
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

/// `type` as "sensor_msgs::msg::dds_::LaserScan_".
inline DataReader* read_topic(DomainParticipant* participant, const std::string& name, const std::string& type,
                              bool reliable) {
  DataReaderQos qos = DATAREADER_QOS_DEFAULT;
  qos.reliability().kind = reliable ? RELIABLE_RELIABILITY_QOS : BEST_EFFORT_RELIABILITY_QOS;
  qos.endpoint().history_memory_policy = eprosima::fastrtps::rtps::DYNAMIC_RESERVE_MEMORY_MODE;
  TypeSupport(new Bytes(type)).register_type(participant);
  return participant->create_subscriber(SUBSCRIBER_QOS_DEFAULT)
      ->create_datareader(participant->create_topic(name, type, TOPIC_QOS_DEFAULT), qos);
}

inline DataWriter* write_topic(DomainParticipant* participant, const std::string& name, const std::string& type,
                               bool reliable) {
  DataWriterQos qos = DATAWRITER_QOS_DEFAULT;
  qos.reliability().kind = reliable ? RELIABLE_RELIABILITY_QOS : BEST_EFFORT_RELIABILITY_QOS;
  qos.endpoint().history_memory_policy = eprosima::fastrtps::rtps::DYNAMIC_RESERVE_MEMORY_MODE;
  TypeSupport(new Bytes(type)).register_type(participant);
  return participant->create_publisher(PUBLISHER_QOS_DEFAULT)
      ->create_datawriter(participant->create_topic(name, type, TOPIC_QOS_DEFAULT), qos);
}
