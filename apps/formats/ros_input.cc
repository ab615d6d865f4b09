#include "apps/formats/ros_input.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>

namespace jaywalk::exchange {
namespace {

constexpr std::size_t kCovarianceBytes = 36 * sizeof(double);
constexpr std::size_t kLeastTransformBytes = 60;
/// A quaternion's length may be so far off 1 by rounding; one that is farther off never was one.
constexpr double kOffLength = 0.1;

/// Stamp and frame.
std::pair<Time, std::string> read_header(WireReader& in, Wire wire) {
  if (wire == Wire::kRos1) (void)in.u32();       // its running number
  const std::chrono::seconds seconds(in.u32());  // ROS 2's are signed, and never below zero
  const std::chrono::nanoseconds nanoseconds(in.u32());
  return {Time{seconds + nanoseconds}, std::string(in.text())};
}

/// Also the length of its quaternion.
std::pair<SpatialFrame, double> read_frame(WireReader& in) {
  const double x = in.f64(), y = in.f64(), z = in.f64();
  Eigen::Vector4d xyzw;
  for (int k = 0; k < 4; ++k) xyzw[k] = in.f64();
  if (xyzw.allFinite()) return {spatial_frame(x, y, z, xyzw), xyzw.norm()};
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  return {spatial_frame(kNone, kNone, kNone, {0.0, 0.0, 0.0, 1.0}), 1.0};
}

Pose2 in_the_plane(const std::pair<SpatialFrame, double>& read) {
  const auto& [frame, length] = read;
  const bool turns = std::fabs(length - 1.0) < kOffLength;
  return {frame.translation().x(), frame.translation().y(),
          turns ? heading_of(frame) : std::numeric_limits<double>::quiet_NaN()};
}

constexpr double kSame = 1e-3;        // m, and of a direction's cosines
constexpr double kLevel = 0.985;      // cosine of 10 degrees
constexpr std::size_t kDeepest = 64;  // frames in one another: more is a circle

enum WireType : std::uint8_t { kVarint = 0, kEightBytes = 1, kSized = 2, kFourBytes = 5 };

/// A field of a message (protobuf.dev/programming-guides/encoding): a value, or bytes.
struct ProtoField {
  std::uint32_t number = 0;
  std::uint64_t value = 0;
  std::string_view bytes = {};
  [[nodiscard]] double f64() const { return WireReader(bytes).f64(); }
};

/// Nothing where none begins there.
std::optional<std::uint64_t> read_varint(WireReader& in) {
  std::uint64_t value = 0;
  for (unsigned shift = 0; shift < 64; shift += 7) {
    const auto byte = in.number<std::uint8_t>();
    value |= static_cast<std::uint64_t>(byte & 0x7FU) << shift;
    if ((byte & 0x80U) == 0) return in.ok() ? std::optional(value) : std::nullopt;
  }
  return std::nullopt;
}

/// Nothing where the bytes are no message.
std::optional<ProtoField> read_field(WireReader& in) {
  const auto key = read_varint(in);
  if (!key) return std::nullopt;
  const std::uint64_t type = *key & 7U;
  std::optional<std::uint64_t> said;  // the value, or how many bytes
  if (type == kVarint || type == kSized) said = read_varint(in);
  if (type == kEightBytes) said = 8;
  if (type == kFourBytes) said = 4;
  if (!said) return std::nullopt;
  ProtoField field{.number = static_cast<std::uint32_t>(*key >> 3U)};
  if (type == kVarint)
    field.value = *said;
  else
    field.bytes = in.take(*said);
  return in.ok() ? std::optional(field) : std::nullopt;
}

/// Each field of `bytes` to `take(field)`; false where they are no message.
template <class Take>
bool each_field(std::string_view bytes, const Take& take) {
  WireReader in(bytes);
  while (!in.empty()) {
    const auto field = read_field(in);
    if (!field) return false;
    take(*field);
  }
  return true;
}

/// google.protobuf.Timestamp.
Time read_time(std::string_view bytes, bool& ok) {
  std::uint64_t seconds = 0, nanoseconds = 0;
  ok = each_field(bytes, [&](const ProtoField& f) { (f.number == 1 ? seconds : nanoseconds) = f.value; }) && ok;
  ok = ok && seconds <= 0xFFFFFFFFU && nanoseconds < 1'000'000'000U;
  return ok ? Time{std::chrono::seconds(seconds) + std::chrono::nanoseconds(nanoseconds)} : kNever;
}

/// Fields 1 to 4, doubles: foxglove.Vector3, foxglove.Quaternion. What is not said is 0.
std::array<double, 4> read_doubles(std::string_view bytes, bool& ok) {
  std::array<double, 4> all{};
  const auto take = [&](const ProtoField& f) {
    if (f.number >= 1 && f.number <= all.size() && f.bytes.size() == 8) all[f.number - 1] = f.f64();
  };
  ok = each_field(bytes, take) && ok;
  return all;
}

SpatialFrame frame_of(std::string_view position, std::string_view rotation, bool& ok) {
  const auto at = read_doubles(position, ok);
  const auto turn = read_doubles(rotation, ok);
  return spatial_frame(at[0], at[1], at[2], {turn[0], turn[1], turn[2], turn[3]});
}

}  // namespace

std::optional<ScanMessage> read_scan(std::string_view bytes, Wire wire) {
  WireReader in(bytes, wire);
  ScanMessage scan;
  std::tie(scan.stamp, scan.frame) = read_header(in, wire);
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
  odometry.stamp = read_header(in, wire).first;
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
    transform.parent = read_header(in, wire).second;
    transform.child = in.text();
    transform.parent_from_child = read_frame(in).first;
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

FrameTree::Chain FrameTree::above(const std::string& frame) const {
  Chain chain{{bare(frame), SpatialFrame::Identity()}};
  while (chain.size() < kDeepest) {
    const auto& [at, at_from_frame] = chain.back();
    const auto up = parents_.find(at);
    if (up == parents_.end() || up->second.moves) break;
    chain.emplace_back(up->second.parent, SpatialFrame(up->second.parent_from_child * at_from_frame));
  }
  return chain;
}

std::optional<SpatialFrame> FrameTree::find(const std::string& base, const std::string& frame) const {
  const Chain above_frame = above(frame);
  for (const auto& [at, at_from_base] : above(base)) {
    const auto met = std::ranges::find(above_frame, at, &Chain::value_type::first);
    if (met != above_frame.end()) return at_from_base.inverse() * met->second;
  }
  return std::nullopt;
}

std::optional<LaserMount> level_mount(const SpatialFrame& base_from_laser) {
  const double up = base_from_laser.linear()(2, 2);
  if (!(std::fabs(up) >= kLevel)) return std::nullopt;
  const Eigen::Vector3d at = base_from_laser.translation();
  return LaserMount{{at.x(), at.y(), heading_of(base_from_laser)}, up < 0.0};
}

std::optional<ScanMessage> read_foxglove_scan(std::string_view bytes) {
  ScanMessage scan;
  scan.stamp = Time{};
  scan.range_max_m = std::numeric_limits<float>::infinity();
  double first = 0.0, last = 0.0;
  std::string_view position, rotation;
  bool ok = true;
  const bool read = each_field(bytes, [&](const ProtoField& f) {
    if (f.number == 1) scan.stamp = read_time(f.bytes, ok);
    if (f.number == 2) scan.frame = f.bytes;
    if (f.number == 3)
      ok = each_field(f.bytes, [&](const ProtoField& p) { (p.number == 1 ? position : rotation) = p.bytes; }) && ok;
    if (f.number == 4) first = f.f64();
    if (f.number == 5) last = f.f64();
    if (f.number != 6) return;
    WireReader ranges(f.bytes);
    ok = ok && f.bytes.size() % sizeof(double) == 0;
    while (!ranges.empty() && ranges.ok()) scan.range_m.push_back(static_cast<float>(ranges.number<double>()));
  });
  if (!read || !ok) return std::nullopt;
  const SpatialFrame frame_from_scan = frame_of(position, rotation, ok);
  scan.frame_from_scan = {frame_from_scan.translation().x(), frame_from_scan.translation().y(),
                          heading_of(frame_from_scan)};
  scan.first_angle_rad = static_cast<float>(first);
  if (scan.range_m.size() > 1)
    scan.angle_step_rad = static_cast<float>((last - first) / static_cast<double>(scan.range_m.size() - 1));
  return ok ? std::optional(std::move(scan)) : std::nullopt;
}

std::optional<std::vector<TransformMessage>> read_foxglove_transform(std::string_view bytes) {
  TransformMessage transform;
  std::string_view position, rotation;
  bool ok = each_field(bytes, [&](const ProtoField& f) {
    if (f.number == 2) transform.parent = f.bytes;
    if (f.number == 3) transform.child = f.bytes;
    if (f.number == 4) position = f.bytes;
    if (f.number == 5) rotation = f.bytes;
  });
  transform.parent_from_child = frame_of(position, rotation, ok);
  return ok ? std::optional(std::vector{std::move(transform)}) : std::nullopt;
}

std::optional<std::vector<TransformMessage>> read_foxglove_transforms(std::string_view bytes) {
  std::vector<TransformMessage> all;
  bool ok = true;
  const bool read = each_field(bytes, [&](const ProtoField& f) {
    if (f.number != 1) return;
    const auto one = read_foxglove_transform(f.bytes);
    ok = ok && one;
    if (one) all.push_back(one->front());
  });
  return read && ok ? std::optional(std::move(all)) : std::nullopt;
}

}  // namespace jaywalk::exchange
