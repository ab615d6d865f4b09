#include <array>
#include <limits>

#include "apps/formats/ros_input.h"
#include "apps/formats/wire_reader.h"

namespace jaywalk::exchange {
namespace {

enum WireType : std::uint8_t { kVarint = 0, kEightBytes = 1, kSized = 2, kFourBytes = 5 };

/// The fields of a message one after the other (protobuf.dev/programming-guides/encoding).
class ProtoFields {
 public:
  explicit ProtoFields(std::string_view bytes) : in_(bytes) {}

  /// The next field; false at the end, or where the bytes are no message.
  bool next() {
    if (in_.empty() || !ok()) return false;
    const std::uint64_t key = varint();
    number_ = static_cast<std::uint32_t>(key >> 3U);
    bytes_ = {};
    value_ = 0;
    const auto type = static_cast<std::uint8_t>(key & 7U);
    if (type == kVarint)
      value_ = varint();
    else if (type == kEightBytes)
      bytes_ = in_.take(8);
    else if (type == kSized)
      bytes_ = in_.take(varint());
    else if (type == kFourBytes)
      bytes_ = in_.take(4);
    else
      known_ = false;
    return ok();
  }
  [[nodiscard]] bool ok() const { return known_ && in_.ok(); }
  [[nodiscard]] std::uint32_t number() const { return number_; }
  [[nodiscard]] std::uint64_t value() const { return value_; }
  [[nodiscard]] std::string_view bytes() const { return bytes_; }
  [[nodiscard]] double f64() const { return WireReader(bytes_).number<double>(); }

 private:
  std::uint64_t varint() {
    std::uint64_t value = 0;
    for (unsigned shift = 0; shift < 64; shift += 7) {
      const auto byte = in_.number<std::uint8_t>();
      value |= static_cast<std::uint64_t>(byte & 0x7FU) << shift;
      if ((byte & 0x80U) == 0) return value;
    }
    known_ = false;
    return 0;
  }

  WireReader in_;
  bool known_ = true;
  std::uint32_t number_ = 0;
  std::uint64_t value_ = 0;
  std::string_view bytes_;
};

/// Each field of `bytes` to `take(fields)`; false where they are no message.
template <class Take>
bool each_field(std::string_view bytes, const Take& take) {
  ProtoFields fields(bytes);
  while (fields.next()) take(fields);
  return fields.ok();
}

/// google.protobuf.Timestamp.
Time read_time(std::string_view bytes, bool& ok) {
  std::uint64_t seconds = 0, nanoseconds = 0;
  ok = each_field(bytes, [&](const ProtoFields& f) { (f.number() == 1 ? seconds : nanoseconds) = f.value(); }) && ok;
  ok = ok && seconds <= 0xFFFFFFFFU && nanoseconds < 1'000'000'000U;
  return ok ? Time{std::chrono::seconds(seconds) + std::chrono::nanoseconds(nanoseconds)} : kNever;
}

/// Fields 1 to N, doubles: foxglove.Vector3, foxglove.Quaternion. What is not said is 0.
template <std::size_t N>
std::array<double, N> read_doubles(std::string_view bytes, bool& ok) {
  std::array<double, N> all{};
  ok = each_field(bytes,
                  [&](const ProtoFields& f) {
                    if (f.number() >= 1 && f.number() <= N && f.bytes().size() == 8) all[f.number() - 1] = f.f64();
                  }) &&
       ok;
  return all;
}

SpatialFrame frame_of(std::string_view position, std::string_view rotation, bool& ok) {
  const auto at = read_doubles<3>(position, ok);
  const auto turn = read_doubles<4>(rotation, ok);
  return spatial_frame(at[0], at[1], at[2], {turn[0], turn[1], turn[2], turn[3]});
}

}  // namespace

std::optional<ScanMessage> read_foxglove_scan(std::string_view bytes) {
  ScanMessage scan;
  scan.stamp = Time{};
  scan.range_max_m = std::numeric_limits<float>::infinity();
  double first = 0.0, last = 0.0;
  std::string_view position, rotation;
  bool ok = true;
  const bool read = each_field(bytes, [&](const ProtoFields& f) {
    if (f.number() == 1) scan.stamp = read_time(f.bytes(), ok);
    if (f.number() == 2) scan.frame = f.bytes();
    if (f.number() == 3)
      ok = each_field(f.bytes(), [&](const ProtoFields& p) { (p.number() == 1 ? position : rotation) = p.bytes(); }) &&
           ok;
    if (f.number() == 4) first = f.f64();
    if (f.number() == 5) last = f.f64();
    if (f.number() != 6) return;
    WireReader ranges(f.bytes());
    ok = ok && f.bytes().size() % sizeof(double) == 0;
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

std::optional<TransformMessage> read_foxglove_transform(std::string_view bytes) {
  TransformMessage transform;
  std::string_view position, rotation;
  bool ok = each_field(bytes, [&](const ProtoFields& f) {
    if (f.number() == 2) transform.parent = f.bytes();
    if (f.number() == 3) transform.child = f.bytes();
    if (f.number() == 4) position = f.bytes();
    if (f.number() == 5) rotation = f.bytes();
  });
  transform.parent_from_child = frame_of(position, rotation, ok);
  return ok ? std::optional(std::move(transform)) : std::nullopt;
}

std::optional<std::vector<TransformMessage>> read_foxglove_transforms(std::string_view bytes) {
  std::vector<TransformMessage> all;
  bool ok = true;
  const bool read = each_field(bytes, [&](const ProtoFields& f) {
    if (f.number() != 1) return;
    auto transform = read_foxglove_transform(f.bytes());
    ok = ok && transform;
    if (transform) all.push_back(std::move(*transform));
  });
  return read && ok ? std::optional(std::move(all)) : std::nullopt;
}

}  // namespace jaywalk::exchange
