#include "apps/dds/robot_bridge.h"

#include <ros_topics.h>  // idlc writes it

#include <algorithm>
#include <bit>
#include <cstdio>
#include <thread>

#include "firmware/robot/robot_devices.h"
#include "hal/types/errors.h"

namespace jaywalk::dds {
namespace {
constexpr Duration kSilence = std::chrono::milliseconds(100);  // SAFETY 4
constexpr Duration kStopping = std::chrono::seconds(1), kStopPeriod = std::chrono::milliseconds(50);

exchange::ScanMessage in_fields(const sensor_msgs_msg_dds__LaserScan_& scan) {
  exchange::ScanMessage out;
  out.stamp = time_of(scan.header_.stamp_);
  out.first_angle_rad = scan.angle_min_;
  out.angle_step_rad = scan.angle_increment_;
  out.beam_step_s = scan.time_increment_;
  out.range_min_m = scan.range_min_;
  out.range_max_m = scan.range_max_;
  out.range_m.assign(scan.ranges_._buffer, scan.ranges_._buffer + scan.ranges_._length);
  return out;
}

exchange::OdometryMessage in_fields(const nav_msgs_msg_dds__Odometry_& odometry) {
  const auto& at = odometry.pose_.pose_.position_;
  const auto& turned = odometry.pose_.pose_.orientation_;
  exchange::OdometryMessage out;
  out.stamp = time_of(odometry.header_.stamp_);
  out.pose = {at.x_, at.y_,
              std::atan2(2.0 * (turned.w_ * turned.z_ + turned.x_ * turned.y_),
                         1.0 - 2.0 * (turned.y_ * turned.y_ + turned.z_ * turned.z_))};
  out.twist = {odometry.twist_.twist_.linear_.x_, odometry.twist_.twist_.angular_.z_};
  return out;
}

}  // namespace

RobotBridge::RobotBridge(const RobotFile& robot, std::uint32_t domain)
    : robot_(robot),
      participant_(checked(dds_create_participant(domain, nullptr, nullptr), "no participant")),
      waits_(checked(dds_create_waitset(participant_), "no waitset")),
      scan_feed_(robot.setup.model.laser),
      odometry_feed_(robot.setup.model.drive) {
  if (robot.laser.kind == ScannerKind::kDds) add_laser(robot.laser);
  if (robot.drive.kind == DriveKind::kDds) add_base(robot.drive.ros);
  if (scans_ == 0 && odometry_ == 0)
    throw StartupError("the robot file names no ROS 2 device", "write kind = \"dds\" in [laser], [drive] or both");
}

RobotBridge::~RobotBridge() { dds_delete(participant_); }

void RobotBridge::add_laser(const LaserWiring& wiring) {
  scan_ring_.emplace(ring_path(wiring.topic), ros::kScanRing);
  scans_ =
      make_reader(participant_, sensor_msgs_msg_dds__LaserScan__desc, wiring.topic, qos_keeping(1, wiring.reliable));
  attach(scans_);
}

void RobotBridge::add_base(const ros::BaseSetup& base) {
  state_ring_.emplace(ring_path(base.odometry), ros::kBaseRing);
  order_ring_.emplace(ring_path(base.command), ros::kBaseRing);
  const auto& type = base.stamped ? geometry_msgs_msg_dds__TwistStamped__desc : geometry_msgs_msg_dds__Twist__desc;
  commands_ = make_writer(participant_, type, base.command, qos_keeping(1, true));
  odometry_ = make_reader(participant_, nav_msgs_msg_dds__Odometry__desc, base.odometry, qos_keeping(4, base.reliable));
  const Qos others = qos_keeping(1, false);
  dds_qset_ignorelocal(others.get(), DDS_IGNORELOCAL_PARTICIPANT);
  others_commands_ = make_reader(participant_, type, base.command, others);
  attach(odometry_);
  attach(others_commands_);
}

void RobotBridge::attach(dds_entity_t reader) {
  checked(dds_set_status_mask(reader, DDS_DATA_AVAILABLE_STATUS), "no status");
  checked(dds_waitset_attach(waits_, reader, reader), "cannot wait");
}

void RobotBridge::pass_in(std::chrono::milliseconds most) {
  (void)dds_waitset_wait(waits_, nullptr, 0, DDS_MSECS(most.count()));
  if (scans_ != 0) pass_scans();
  if (odometry_ == 0) return;
  pass_odometry();
  watch_commands();
}

void RobotBridge::pass_scans() {
  const std::string& topic = robot_.laser.topic;
  const auto pass = [&](const sensor_msgs_msg_dds__LaserScan_& scan, const dds_sample_info_t& about) {
    const exchange::Arrival now = arrival_of(about, clock_.now());
    if (!is_alone(scans_, topic)) return;
    const auto fitted = scan_feed_.take(in_fields(scan), now);
    if (!fitted) return complain(topic + ": a scan that is no newer than one before");
    if (fitted->beam_count == 0) complain(topic + ": a scan without beams, or of angles or limits that make none");
    tell_late(topic, Time(Duration(fitted->stamp_ns + fitted->sweep_ns)), now.ours);
    ros::SharedRing* const ring = scan_ring_->at(now.ours);
    if (ring != nullptr) ring->write(std::as_bytes(std::span(&*fitted, 1)));
  };
  take_all<sensor_msgs_msg_dds__LaserScan_>(scans_, pass);
}

void RobotBridge::pass_odometry() {
  const std::string& topic = robot_.drive.ros.odometry;
  const auto pass = [&](const nav_msgs_msg_dds__Odometry_& odometry, const dds_sample_info_t& about) {
    if (!is_alone(odometry_, topic)) return;
    const exchange::Arrival now = arrival_of(about, clock_.now());
    const auto wheels = odometry_feed_.take(in_fields(odometry), now);
    if (!wheels) return complain(topic + ": a pose or twist that no robot has, or no newer than one before");
    tell_late(topic, wheels->stamp, now.ours);
    dds_publication_matched_status_t matched{};
    dds_get_publication_matched_status(commands_, &matched);
    CanFrame listeners{.id = ros::kListeners, .size = 1};
    listeners.bytes[0] = static_cast<std::uint8_t>(std::min(matched.current_count, 255U));
    send(wheels->stamp, listeners);
    for (std::uint32_t k = 0; k < 2; ++k) send(wheels->stamp, ros::to_frame(ros::kWheel + k, wheels->wheels[k]));
  };
  take_all<nav_msgs_msg_dds__Odometry_>(odometry_, pass);
}

void RobotBridge::tell_late(const std::string& topic, Time sent, Time now) {
  if (now - sent > kSilence) complain(topic + ": comes late, or clocks differ: synchronise them");
}

/// Two masters of one base would stop each other's stops (SAFETY 16).
void RobotBridge::watch_commands() {
  const auto tell = [&](const auto&, const auto&) { send(clock_.now(), {.id = ros::kOtherMaster}); };
  if (robot_.drive.ros.stamped)
    take_all<geometry_msgs_msg_dds__TwistStamped_>(others_commands_, tell);
  else
    take_all<geometry_msgs_msg_dds__Twist_>(others_commands_, tell);
}

void RobotBridge::send(Time stamp, const CanFrame& frame) {
  ros::SharedRing* const ring = state_ring_->at(clock_.now());
  const ros::BaseMessage message{stamp.time_since_epoch().count(), frame.id, frame.size, frame.bytes};
  if (ring != nullptr) ring->write(std::as_bytes(std::span(&message, 1)));
}

bool RobotBridge::is_alone(dds_entity_t reader, const std::string& topic) {
  dds_subscription_matched_status_t matched{};
  dds_get_subscription_matched_status(reader, &matched);
  if (matched.current_count <= 1) return true;
  complain(topic + ": more than one publisher; a run's own topics go out below a --namespace");
  return false;
}

void RobotBridge::complain(const std::string& what) {
  const std::uint64_t times = ++complaints_[what];
  if (std::has_single_bit(times)) std::fprintf(stderr, "jaywalk_dds: %s (%llu)\n", what.c_str(), 0ULL + times);
}

void RobotBridge::pass_out(std::chrono::milliseconds most) {
  ros::SharedRing* const ring = order_ring_ ? order_ring_->at(clock_.now()) : nullptr;
  if (ring == nullptr) {
    std::this_thread::sleep_for(most);
    return keep_stopped(clock_.now());
  }
  ring->wait(std::min<Duration>(most, kSilence / 4));
  if (const std::uint64_t alarms = ring->alarms(); std::exchange(alarms_, alarms) != alarms && ordered_ != kNever)
    publish({});
  ros::BaseMessage order;
  const auto bytes = std::as_writable_bytes(std::span(&order, 1));
  for (auto took = ring->read(bytes); took != ros::SharedRing::Took::kNothing; took = ring->read(bytes))
    if (took == ros::SharedRing::Took::kMessage) obey(order);
  keep_stopped(clock_.now());
}

void RobotBridge::obey(const ros::BaseMessage& order) {
  const auto wheel = ros::wheel_in(
      {.id = order.id, .size = static_cast<std::uint8_t>(std::min(order.size, 9U)), .bytes = order.bytes});
  const std::optional<float> left_radps = std::exchange(left_radps_, std::nullopt);
  const Duration old = clock_.now() - Time(Duration(order.stamp_ns));
  if (!wheel || old < Duration{0} || old > kSilence) return;  // what lay there while this program was held up
  if (order.id == ros::kWheelOrder) left_radps_ = wheel->speed_radps;
  if (order.id != ros::kWheelOrder + 1 || !left_radps) return;
  const auto twist = exchange::twist_of(static_cast<double>(*left_radps), static_cast<double>(wheel->speed_radps),
                                        robot_.setup.model.drive);
  if (!twist) return;
  ordered_ = clock_.now();
  publish(*twist);
}

void RobotBridge::keep_stopped(Time now) {
  if (ordered_ == kNever || now - ordered_ <= kSilence) return;
  if (now - ordered_ > kStopping) ordered_ = kNever;
  if (age(zero_sent_, now) < kStopPeriod) return;
  zero_sent_ = now;
  publish({});
}

void RobotBridge::publish(const Twist2& twist) {
  geometry_msgs_msg_dds__TwistStamped_ stamped{};
  stamped.twist_.linear_.x_ = twist.v_mps;
  stamped.twist_.angular_.z_ = twist.w_radps;
  if (!robot_.drive.ros.stamped) return (void)dds_write(commands_, &stamped.twist_);
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  char frame[] = "base_link";
  stamped.header_.frame_id_ = frame;
  stamped.header_.stamp_.sec_ = static_cast<std::int32_t>(now / std::chrono::seconds(1));
  stamped.header_.stamp_.nanosec_ =
      static_cast<std::uint32_t>((now % std::chrono::seconds(1)) / std::chrono::nanoseconds(1));
  (void)dds_write(commands_, &stamped);
}

void RobotBridge::stop() {
  if (commands_ != 0) publish({});
}

}  // namespace jaywalk::dds
