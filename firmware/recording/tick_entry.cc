#include <algorithm>
#include <bit>
#include <concepts>
#include <limits>
#include <type_traits>

#include "drivers/wire/byte_reader.h"
#include "firmware/recording/recorder.h"

namespace jaywalk {
namespace {

// One list of fields serves both directions, Put and Get, so that writer and reader cannot drift apart. Values are
// little-endian bytes, floating point as its bits, NaN payloads and all.

/// What does not fit into the bytes is left out.
class Put {
 public:
  explicit Put(std::span<unsigned char> bytes) : bytes_(bytes) {}

  template <std::integral T>
  void operator()(const T& value) {
    if (bytes_.size() - written_ < sizeof(T)) return;
    wire::put_little_endian(static_cast<std::make_unsigned_t<T>>(value), bytes_.subspan(written_));
    written_ += sizeof(T);
  }
  void operator()(const float& value) { (*this)(std::bit_cast<std::uint32_t>(value)); }
  void operator()(const double& value) { (*this)(std::bit_cast<std::uint64_t>(value)); }
  void operator()(const bool& value) { (*this)(static_cast<std::uint8_t>(value ? 1 : 0)); }
  void operator()(const Duration& value) { (*this)(static_cast<std::int64_t>(value.count())); }
  void operator()(const Time& value) { (*this)(value.time_since_epoch()); }
  template <class Enum>
  requires std::is_enum_v<Enum>
  void operator()(const Enum& value) { (*this)(static_cast<std::underlying_type_t<Enum>>(value)); }
  std::uint32_t count(std::uint32_t n, std::uint32_t limit) {
    n = std::min(n, limit);
    (*this)(n);
    return n;
  }
  template <class T, std::size_t N>
  void size(const FixedVector<T, N>& items) {
    (*this)(static_cast<std::uint32_t>(items.size()));
  }
  /// A number that is mostly small: seven bits a byte, the lowest first; 0, -1, 1, -2 as 0, 1, 2, 3.
  void small_number(std::int64_t value) {
    auto bits = (static_cast<std::uint64_t>(value) << 1U) ^ static_cast<std::uint64_t>(value >> 63U);
    for (; bits > 0x7FU; bits >>= 7U) (*this)(static_cast<std::uint8_t>(bits | 0x80U));
    (*this)(static_cast<std::uint8_t>(bits));
  }
  [[nodiscard]] std::size_t written() const { return written_; }

 private:
  std::span<unsigned char> bytes_;
  std::size_t written_ = 0;
};

/// Past the end it gives zeros, and the record is refused.
class Get {
 public:
  explicit Get(std::span<const unsigned char> bytes) : bytes_(bytes) {}

  template <std::integral T>
  void operator()(T& value) {
    value = static_cast<T>(bytes_.little<std::make_unsigned_t<T>>());
  }
  void operator()(float& value) { value = std::bit_cast<float>(number_to<std::uint32_t>()); }
  void operator()(double& value) { value = std::bit_cast<double>(number_to<std::uint64_t>()); }
  void operator()(bool& value) { value = number_to<std::uint8_t>(1) == 1; }
  void operator()(Duration& value) { value = Duration{number_to<std::int64_t>()}; }
  void operator()(Time& value) { value = Time{Duration{number_to<std::int64_t>()}}; }
  void operator()(PlanStatus& value) { up_to(PlanStatus::kBackendFailed, value); }
  void operator()(StopStage& value) { up_to(StopStage::kSilent, value); }
  void operator()(DriveTrouble& value) { up_to(kLastDriveTrouble, value); }
  void operator()(DriveFaultKind& value) { up_to(kLastDriveFaultKind, value); }
  void operator()(Reason& value) { value = static_cast<Reason>(number_to<std::uint32_t>()); }
  std::uint32_t count(std::uint32_t& n, std::uint32_t limit) { return n = number_to(limit); }
  /// Items that were there stay, those that come are empty.
  template <class T, std::size_t N>
  void size(FixedVector<T, N>& items) {
    const auto n = number_to(static_cast<std::uint32_t>(N));
    while (items.size() < n) static_cast<void>(items.push_back({}));
    items.truncate(n);
  }
  void small_number(std::int64_t& value) {
    std::uint64_t bits = 0;
    std::uint8_t byte = 0x80;
    for (unsigned shift = 0; (byte & 0x80U) != 0; shift += 7) {
      if (shift > 63) return refuse();
      (*this)(byte);
      bits |= static_cast<std::uint64_t>(byte & 0x7FU) << shift;
    }
    value = static_cast<std::int64_t>(bits >> 1U) ^ -static_cast<std::int64_t>(bits & 1U);
  }
  void refuse() { refused_ = true; }
  [[nodiscard]] bool is_at_end() const { return bytes_.rest().empty(); }
  [[nodiscard]] bool ok() const { return bytes_.ok() && !refused_; }

 private:
  template <class Enum>
  void up_to(Enum most, Enum& value) {
    value = static_cast<Enum>(number_to(static_cast<std::uint8_t>(most)));
  }
  /// A number of at most `most`; 0, and the record is refused, where it exceeds that.
  template <std::integral T>
  T number_to(T most = std::numeric_limits<T>::max()) {
    T value{};
    (*this)(value);
    if (value <= most) return value;
    refuse();
    return 0;
  }

  wire::ByteReader bytes_;
  bool refused_ = false;
};

template <class Archive, class Scan>
void transfer_scan(Archive& ar, Scan& s) {
  ar(s.stamp), ar(s.sequence), ar(s.first_angle_rad), ar(s.angle_step_rad);
  ar(s.range_min_m), ar(s.range_max_m), ar(s.sweep), ar(s.period);
  const std::uint32_t beams = ar.count(s.beam_count, kMaxBeams);
  for (std::uint32_t i = 0; i < beams; ++i) ar(s.range_m[i]);
}

template <class Archive, class Fix>
void transfer_fix(Archive& ar, Fix& f) {
  ar(f.stamp), ar(f.sequence), ar(f.has_pose);
  ar(f.map_from_robot.x), ar(f.map_from_robot.y), ar(f.map_from_robot.heading);
  ar(f.position_std_m), ar(f.heading_std_rad), ar(f.mover_std_m);
  ar.size(f.movers);
  for (auto& m : f.movers) ar(m.id), ar(m.position_in_map.x), ar(m.position_in_map.y), ar(m.radius_m);
}

/// Everything but scan and fix.
template <class Archive, class Record>
void transfer_rest(Archive& ar, Record& r) {
  ar(r.now);
  ar(r.wheels.stamp), ar(r.wheels.sequence), ar(r.wheels.left_rad), ar(r.wheels.right_rad);
  ar(r.wheels.left_radps), ar(r.wheels.right_radps), ar(r.wheels.trouble);
  ar(r.wheels.fault.kind), ar(r.wheels.fault.node), ar(r.wheels.fault.code);
  ar(r.wheels.stop), ar(r.wheels.ready);
  ar(r.input.stamp), ar(r.input.has_goal);
  ar(r.input.goal_in_map.x), ar(r.input.goal_in_map.y), ar(r.input.goal_tolerance_m);
  ar(r.input.goal_heading_rad), ar(r.input.goal_heading_tolerance_rad);
  ar(r.input.emergency_stop), ar(r.input.reset);
  ar(r.input.steers), ar(r.input.stick.forward), ar(r.input.stick.left);
  ar(r.pose.stamp);
  ar(r.pose.map_from_robot.x), ar(r.pose.map_from_robot.y), ar(r.pose.map_from_robot.heading);
  ar(r.pose.position_std_m), ar(r.pose.heading_std_rad);
  ar(r.plan_asked), ar(r.plan_sequence), ar(r.plan_stamp), ar(r.plan_status);
  ar(r.wanted.v_mps), ar(r.wanted.w_radps);
  ar(r.verdict.permitted.v_mps), ar(r.verdict.permitted.w_radps);
  ar(r.verdict.reasons), ar(r.verdict.gap_m);
  ar(r.command.stamp), ar(r.command.left_radps), ar(r.command.right_radps);
  ar(r.took), ar(r.latency.tick_s), ar(r.latency.drive_s);
}

/// Places as the change of the step from one to the next, mm: mostly a byte each.
class Bends {
 public:
  /// What is to be written for the next place.
  [[nodiscard]] std::int64_t bend(std::int64_t at) noexcept {
    const std::int64_t bend = at - at_ - step_;
    step_ += bend, at_ = at;
    return bend;
  }
  /// The place that was written so; no sum overflows, whatever was read.
  [[nodiscard]] std::int64_t place(std::int64_t bend) noexcept {
    const auto sum = [](std::int64_t a, std::int64_t b) {
      return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) + static_cast<std::uint64_t>(b));
    };
    step_ = sum(step_, bend);
    return at_ = sum(at_, step_);
  }

 private:
  std::int64_t at_ = 0, step_ = 0;
};

void put_path(Put& put, const PlannedPath& path) {
  put.size(path.points);
  if (path.points.empty()) return;
  put(path.stamp);
  Bends x, y;
  for (const PointMm& p : path.points) put.small_number(x.bend(p.x)), put.small_number(y.bend(p.y));
}

void get_path(Get& get, PlannedPath& path) {
  path.stamp = kNever;
  get.size(path.points);
  if (!path.points.empty()) get(path.stamp);
  Bends x, y;
  for (PointMm& p : path.points) {
    std::int64_t dx = 0, dy = 0;
    get.small_number(dx), get.small_number(dy);
    const std::int64_t at_x = x.place(dx), at_y = y.place(dy);
    p = {static_cast<std::int32_t>(at_x), static_cast<std::int32_t>(at_y)};
    if (p.x != at_x || p.y != at_y) return get.refuse();
  }
}

/// Those of the other scanners; `written`: which of each stands before this in the recording.
void put_others(Put& put, const TickRecord& record, std::span<std::uint32_t> written, bool first) {
  if (record.other_scans.empty()) return;
  put(record.verdict.faulty_scanners);
  put.size(record.other_scans);
  for (std::size_t k = 0; k < record.other_scans.size(); ++k) {
    const LaserScan& scan = record.other_scans[k];
    const bool is_new = first || scan.sequence != written[k];
    put(is_new);
    if (is_new) transfer_scan(put, scan);
    written[k] = scan.sequence;
  }
}

void get_others(Get& get, Verdict& verdict, OfOthers<LaserScan>& scans) {
  verdict.faulty_scanners = 0;
  if (get.is_at_end()) return scans.clear();
  get(verdict.faulty_scanners);
  get.size(scans);
  if (scans.empty()) get.refuse();
  for (std::size_t k = 0; k < scans.size(); ++k) {
    bool is_new = false;
    get(is_new);
    if (is_new) transfer_scan(get, scans[k] = {});
    scans[k].scanner = static_cast<std::uint8_t>(k + 1);
  }
}

}  // namespace

std::size_t TickEncoder::encode(const TickRecord& record, std::uint64_t lost_before,
                                std::span<unsigned char> out) noexcept {
  const bool new_scan = first_ || record.scan.sequence != scan_sequence_;
  const bool new_fix = first_ || record.fix.sequence != fix_sequence_;
  Put put(out);
  put(lost_before);
  put(new_scan);
  put(new_fix);
  transfer_rest(put, record);
  put_path(put, record.path);
  if (new_scan) transfer_scan(put, record.scan);
  if (new_fix) transfer_fix(put, record.fix);
  put_others(put, record, others_, first_);
  first_ = false;
  scan_sequence_ = record.scan.sequence;
  fix_sequence_ = record.fix.sequence;
  return put.written();
}

bool TickDecoder::decode(std::span<const unsigned char> in, TickRecord& record, std::uint64_t& lost_before) noexcept {
  Get get(in);
  bool new_scan = false, new_fix = false;
  get(lost_before);
  get(new_scan);
  get(new_fix);
  transfer_rest(get, record);
  get_path(get, record.path);
  if (new_scan) transfer_scan(get, scan_ = {});
  if (new_fix) transfer_fix(get, fix_ = {});
  get_others(get, record.verdict, others_);
  record.scan = scan_;
  record.other_scans = others_;
  record.fix = fix_;
  return get.ok() && get.is_at_end();
}

}  // namespace jaywalk
