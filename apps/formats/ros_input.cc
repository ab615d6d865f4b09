#include "apps/formats/ros_input.h"

#include <cmath>
#include <limits>

namespace jaywalk::exchange {
namespace {

constexpr std::size_t kCovarianceBytes = 36 * sizeof(double);
constexpr std::size_t kLeastTransformBytes = 60;
/// A quaternion's length may be so far off 1 by rounding; one that is farther off never was one.
constexpr double kOffLength = 0.1;

struct Header {
  Time stamp = kNever;
  std::string frame;
};

Time read_stamp(WireReader& in) {
  const auto seconds = in.number<std::uint32_t>();  // ROS 2's are signed, and never below zero
  const auto nanoseconds = in.number<std::uint32_t>();
  return Time{std::chrono::seconds(seconds) + std::chrono::nanoseconds(nanoseconds)};
}

Header read_header(WireReader& in, Wire wire) {
  if (wire == Wire::kRos1) (void)in.u32();  // its running number
  Header header;
  header.stamp = read_stamp(in);
  header.frame = in.text();
  return header;
}

struct ReadFrame {
  SpatialFrame frame;
  double length = 1.0;  ///< of its quaternion
};

ReadFrame read_frame(WireReader& in) {
  const double x = in.f64(), y = in.f64(), z = in.f64();
  Eigen::Vector4d xyzw;
  for (int k = 0; k < 4; ++k) xyzw[k] = in.f64();
  if (xyzw.allFinite()) return {spatial_frame(x, y, z, xyzw), xyzw.norm()};
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  return {spatial_frame(kNone, kNone, kNone, {0.0, 0.0, 0.0, 1.0})};
}

Pose2 in_the_plane(const ReadFrame& read) {
  const Eigen::Vector3d at = read.frame.translation();
  const bool turns = std::fabs(read.length - 1.0) < kOffLength;
  return {at.x(), at.y(), turns ? heading_of(read.frame) : std::numeric_limits<double>::quiet_NaN()};
}

}  // namespace

std::optional<ScanMessage> read_scan(std::string_view bytes, Wire wire) {
  WireReader in(bytes, wire);
  const Header header = read_header(in, wire);
  ScanMessage scan;
  scan.stamp = header.stamp;
  scan.frame = header.frame;
  scan.first_angle_rad = in.f32();
  (void)in.f32();  // the last beam's: the step and the number of beams say it as well
  scan.angle_step_rad = in.f32();
  scan.beam_step_s = in.f32();
  (void)in.f32();  // the time from scan to scan: the stamps tell
  scan.range_min_m = in.f32();
  scan.range_max_m = in.f32();
  scan.range_m.resize(in.count(sizeof(float)));
  for (float& range : scan.range_m) range = in.f32();
  return in.ok() ? std::optional(std::move(scan)) : std::nullopt;
}

std::optional<OdometryMessage> read_odometry(std::string_view bytes, Wire wire) {
  WireReader in(bytes, wire);
  OdometryMessage odometry;
  odometry.stamp = read_header(in, wire).stamp;
  odometry.child_frame = in.text();
  odometry.pose = in_the_plane(read_frame(in));
  in.skip(kCovarianceBytes);
  odometry.twist.v_mps = in.f64();
  in.skip(4 * sizeof(double));
  odometry.twist.w_radps = in.f64();
  return in.ok() ? std::optional(std::move(odometry)) : std::nullopt;
}

std::optional<std::vector<TransformMessage>> read_transforms(std::string_view bytes, Wire wire) {
  WireReader in(bytes, wire);
  std::vector<TransformMessage> transforms(in.count(kLeastTransformBytes));
  for (TransformMessage& transform : transforms) {
    transform.parent = read_header(in, wire).frame;
    transform.child = in.text();
    transform.parent_from_child = read_frame(in).frame;
  }
  return in.ok() ? std::optional(std::move(transforms)) : std::nullopt;
}

}  // namespace jaywalk::exchange
