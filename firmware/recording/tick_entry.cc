#include "firmware/recording/tick_entry.h"

#include <algorithm>

namespace jaywalk {
namespace {

// One list of fields serves both directions: Put takes const references and writes, Get takes
// references and reads, so that writer and reader cannot drift apart.

struct Put {
  ByteSink sink;
  template <Number T>
  void operator()(const T& value) {
    sink.number(value);
  }
  void operator()(const bool& value) { sink.number(static_cast<std::uint8_t>(value ? 1 : 0)); }
  void operator()(const Duration& value) { sink.number(static_cast<std::int64_t>(value.count())); }
  void operator()(const Time& value) { sink.number(static_cast<std::int64_t>(value.time_since_epoch().count())); }
  template <class Enum>
  requires std::is_enum_v<Enum>
  void operator()(const Enum& value) { sink.number(static_cast<std::underlying_type_t<Enum>>(value)); }
  std::uint32_t count(std::size_t size) {
    sink.number(static_cast<std::uint32_t>(size));
    return static_cast<std::uint32_t>(size);
  }
};

struct Get {
  ByteSource source;
  template <Number T>
  void operator()(T& value) {
    source.number(value);
  }
  void operator()(bool& value) { value = up_to(1) == 1; }
  void operator()(Duration& value) { value = Duration{ticks()}; }
  void operator()(Time& value) { value = Time{Duration{ticks()}}; }
  void operator()(PlanStatus& value) { up_to(PlanStatus::kBackendFailed, value); }
  void operator()(StopStage& value) { up_to(StopStage::kSilent, value); }
  void operator()(DriveTrouble& value) { up_to(kLastDriveTrouble, value); }
  void operator()(DriveFaultKind& value) { up_to(kLastDriveFaultKind, value); }
  void operator()(Reason& value) {
    std::uint32_t bits = 0;
    source.number(bits);
    value = static_cast<Reason>(bits);
  }
  /// A count that may not exceed `limit`; 0, and the record is refused, where it does.
  std::uint32_t count(std::size_t limit) {
    std::uint32_t n = 0;
    source.number(n);
    if (n > limit) {
      source.refuse();
      return 0;
    }
    return n;
  }

 private:
  template <class Enum>
  void up_to(Enum most, Enum& value) {
    value = static_cast<Enum>(up_to(static_cast<std::uint8_t>(most)));
  }
  std::uint8_t up_to(std::uint8_t most) {
    std::uint8_t value = 0;
    source.number(value);
    if (value > most) {
      source.refuse();
      return 0;
    }
    return value;
  }
  std::int64_t ticks() {
    std::int64_t value = 0;
    source.number(value);
    return value;
  }
};

template <class Archive, class Point>
void transfer_point(Archive& ar, Point& p) {
  ar(p.x), ar(p.y);
}
template <class Archive, class Pose>
void transfer_pose(Archive& ar, Pose& p) {
  ar(p.x), ar(p.y), ar(p.heading);
}
template <class Archive, class Twist>
void transfer_twist(Archive& ar, Twist& t) {
  ar(t.v_mps), ar(t.w_radps);
}

/// All of a scan but its number of beams and their ranges.
template <class Archive, class Scan>
void transfer_scan_frame(Archive& ar, Scan& s) {
  ar(s.stamp), ar(s.sequence), ar(s.first_angle_rad), ar(s.angle_step_rad);
  ar(s.range_min_m), ar(s.range_max_m), ar(s.sweep), ar(s.period);
}

/// All of a fix but its number of movers.
template <class Archive, class Fix>
void transfer_fix_frame(Archive& ar, Fix& f) {
  ar(f.stamp), ar(f.sequence), ar(f.has_pose);
  transfer_pose(ar, f.map_from_robot);
  ar(f.position_std_m), ar(f.heading_std_rad), ar(f.mover_std_m);
}
template <class Archive, class Mover>
void transfer_mover(Archive& ar, Mover& m) {
  ar(m.id);
  transfer_point(ar, m.position_in_map);
  ar(m.radius_m);
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
  transfer_point(ar, r.input.goal_in_map);
  ar(r.input.goal_tolerance_m);
  ar(r.input.goal_heading_rad), ar(r.input.goal_heading_tolerance_rad);
  ar(r.input.emergency_stop), ar(r.input.reset);
  ar(r.input.steers), ar(r.input.stick.forward), ar(r.input.stick.left);
  ar(r.pose.stamp);
  transfer_pose(ar, r.pose.map_from_robot);
  ar(r.pose.position_std_m), ar(r.pose.heading_std_rad);
  ar(r.plan_asked), ar(r.plan_sequence), ar(r.plan_stamp), ar(r.plan_status);
  transfer_twist(ar, r.wanted);
  transfer_twist(ar, r.verdict.permitted);
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
  put.count(path.points.size());
  if (path.points.empty()) return;
  put(path.stamp);
  Bends x, y;
  for (const PointMm& p : path.points) put.sink.small_number(x.bend(p.x)), put.sink.small_number(y.bend(p.y));
}

void get_path(Get& get, PlannedPath& path) {
  path.points.clear();
  path.stamp = kNever;
  const std::uint32_t points = get.count(kMaxPathPoints);
  if (points > 0) get(path.stamp);
  Bends x, y;
  for (std::uint32_t i = 0; i < points; ++i) {
    std::int64_t dx = 0, dy = 0;
    get.source.small_number(dx), get.source.small_number(dy);
    const std::int64_t at_x = x.place(dx), at_y = y.place(dy);
    const PointMm p{static_cast<std::int32_t>(at_x), static_cast<std::int32_t>(at_y)};
    if (p.x != at_x || p.y != at_y) return get.source.refuse();
    static_cast<void>(path.points.push_back(p));  // count() keeps within its capacity
  }
}

void put_scan(Put& put, const LaserScan& scan) {
  transfer_scan_frame(put, scan);
  const std::size_t beams = std::min<std::size_t>(scan.beam_count, kMaxBeams);
  put.count(beams);
  for (std::size_t i = 0; i < beams; ++i) put(scan.range_m[i]);
}

void get_scan(Get& get, LaserScan& scan) {
  scan = LaserScan{};
  transfer_scan_frame(get, scan);
  scan.beam_count = get.count(kMaxBeams);
  for (std::size_t i = 0; i < scan.beam_count; ++i) get(scan.range_m[i]);
}

void put_fix(Put& put, const OutsideFix& fix) {
  transfer_fix_frame(put, fix);
  put.count(fix.movers.size());
  for (const ObservedMover& mover : fix.movers) transfer_mover(put, mover);
}

void get_fix(Get& get, OutsideFix& fix) {
  fix = OutsideFix{};
  transfer_fix_frame(get, fix);
  const std::uint32_t movers = get.count(kMaxObservedMovers);
  for (std::uint32_t i = 0; i < movers; ++i) {
    ObservedMover mover;
    transfer_mover(get, mover);
    static_cast<void>(fix.movers.push_back(mover));  // count() keeps within its capacity
  }
}

/// Those of the other scanners; `written`: which of each stands before this in the recording.
void put_others(Put& put, const TickRecord& record, std::span<std::uint32_t> written, bool first) {
  if (record.other_scans.empty()) return;
  put(record.verdict.faulty_scanners);
  put.count(record.other_scans.size());
  for (std::size_t k = 0; k < record.other_scans.size(); ++k) {
    const LaserScan& scan = record.other_scans[k];
    const bool is_new = first || scan.sequence != written[k];
    put(is_new);
    if (is_new) put_scan(put, scan);
    written[k] = scan.sequence;
  }
}

void get_others(Get& get, Verdict& verdict, OfOthers<LaserScan>& scans) {
  verdict.faulty_scanners = 0;
  if (get.source.left() == 0) return scans.clear();
  get(verdict.faulty_scanners);
  const std::uint32_t count = get.count(scans.capacity());
  if (count == 0) get.source.refuse();
  while (scans.size() < count) (void)scans.push_back({});
  scans.truncate(count);
  for (std::size_t k = 0; k < count; ++k) {
    bool is_new = false;
    get(is_new);
    if (is_new) get_scan(get, scans[k]);
    scans[k].scanner = static_cast<std::uint8_t>(k + 1);
  }
}

}  // namespace

std::size_t TickEncoder::encode(const TickRecord& record, std::uint64_t lost_before,
                                std::span<unsigned char> out) noexcept {
  const bool new_scan = first_ || record.scan.sequence != scan_sequence_;
  const bool new_fix = first_ || record.fix.sequence != fix_sequence_;
  Put put{ByteSink(out)};
  put(lost_before);
  put(new_scan);
  put(new_fix);
  transfer_rest(put, record);
  put_path(put, record.path);
  if (new_scan) put_scan(put, record.scan);
  if (new_fix) put_fix(put, record.fix);
  put_others(put, record, others_, first_);
  first_ = false;
  scan_sequence_ = record.scan.sequence;
  fix_sequence_ = record.fix.sequence;
  return put.sink.size();
}

bool TickDecoder::decode(std::span<const unsigned char> in, TickRecord& record, std::uint64_t& lost_before) noexcept {
  Get get{ByteSource(in)};
  bool new_scan = false;
  bool new_fix = false;
  get(lost_before);
  get(new_scan);
  get(new_fix);
  transfer_rest(get, record);
  get_path(get, record.path);
  if (new_scan) get_scan(get, scan_);
  if (new_fix) get_fix(get, fix_);
  get_others(get, record.verdict, others_);
  record.scan = scan_;
  record.other_scans = others_;
  record.fix = fix_;
  return get.source.ok() && get.source.left() == 0;
}

}  // namespace jaywalk
