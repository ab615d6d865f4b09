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

constexpr double kSame = 1e-3;        // m, and of a direction's cosines
constexpr double kLevel = 0.985;      // cosine of 10 degrees
constexpr std::size_t kDeepest = 64;  // frames in one another: more is a circle

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

void FrameTree::add(const TransformMessage& transform) {
  if (!transform.parent_from_child.matrix().allFinite()) return;
  const Edge edge{bare(transform.parent), transform.parent_from_child};
  const auto [known, is_new] = parents_.emplace(bare(transform.child), edge);
  if (is_new) return;
  const bool same = known->second.parent == edge.parent &&
                    known->second.parent_from_child.matrix().isApprox(edge.parent_from_child.matrix(), kSame);
  known->second.moves = known->second.moves || !same;
}

std::optional<SpatialFrame> FrameTree::find(const std::string& base, const std::string& frame) const {
  std::map<std::string, SpatialFrame> above_frame;  // ancestor_from_frame, and of the frame itself
  std::string at = bare(frame);
  SpatialFrame here_from_frame = SpatialFrame::Identity();
  for (std::size_t depth = 0; depth < kDeepest; ++depth) {
    above_frame.emplace(at, here_from_frame);
    const auto up = parents_.find(at);
    if (up == parents_.end() || up->second.moves) break;
    here_from_frame = up->second.parent_from_child * here_from_frame;
    at = up->second.parent;
  }
  at = bare(base);
  SpatialFrame here_from_base = SpatialFrame::Identity();
  for (std::size_t depth = 0; depth < kDeepest; ++depth) {
    if (const auto met = above_frame.find(at); met != above_frame.end()) return here_from_base.inverse() * met->second;
    const auto up = parents_.find(at);
    if (up == parents_.end() || up->second.moves) return std::nullopt;
    here_from_base = up->second.parent_from_child * here_from_base;
    at = up->second.parent;
  }
  return std::nullopt;
}

std::optional<LaserMount> level_mount(const SpatialFrame& base_from_laser) {
  const double up = base_from_laser.linear()(2, 2);
  if (!(std::fabs(up) >= kLevel)) return std::nullopt;
  const Eigen::Vector3d at = base_from_laser.translation();
  return LaserMount{{at.x(), at.y(), heading_of(base_from_laser)}, up < 0.0};
}

}  // namespace jaywalk::exchange
