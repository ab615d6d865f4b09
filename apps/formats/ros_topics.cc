#include "apps/formats/ros_topics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "apps/formats/wire_reader.h"
#include "hal/shown_text.h"

namespace jaywalk::exchange {
namespace {

constexpr Duration kMapEvery = std::chrono::seconds(2);
constexpr Duration kDiagnosticsEvery = std::chrono::milliseconds(100);

constexpr std::int64_t kBillion = 1'000'000'000;

void stamp(CdrWriter& out, Time time) {
  const std::int64_t ns = std::max<std::int64_t>(time.time_since_epoch().count(), 0);
  out.i32(ns / kBillion).u32(static_cast<std::size_t>(ns % kBillion));
}
void header(CdrWriter& out, Time time, const std::string& frame) {
  stamp(out, time);
  out.text(frame);
}
void vector(CdrWriter& out, double x, double y, double z) { out.f64(x).f64(y).f64(z); }
void pose(CdrWriter& out, const Pose2& p) {
  vector(out, p.x, p.y, 0.0);
  out.f64(0.0).f64(0.0).f64(std::sin(0.5 * p.heading)).f64(std::cos(0.5 * p.heading));
}
/// Variances along x and y (m2, m2/s2) and about z (rad2, rad2/s2), as large as filters expect of wheels; what wheels
/// do not measure is unknown.
void covariance(CdrWriter& out) {
  constexpr std::array kVariances{1e-3, 1e-3, 1e6, 1e6, 1e6, 0.03};
  for (std::size_t k = 0; k < 36; ++k) out.f64(k % 7 == 0 ? kVariances[k / 7] : 0.0);
}
void twist(CdrWriter& out, const Twist2& t) {
  vector(out, t.v_mps, 0.0, 0.0);
  vector(out, 0.0, 0.0, t.w_radps);
}
void transform(CdrWriter& out, Time time, const std::string& from, const std::string& to, const Pose2& p) {
  header(out, time, from);
  out.text(to);
  pose(out, p);
}
/// Range of a beam in a LaserScan message, m: infinity where nothing is within reach, NaN without a reading (REP 117).
double range_of(const LaserScan& scan, std::size_t beam) {
  if (scan.is_hit(beam)) return static_cast<double>(scan.range_m[beam]);
  return scan.found_nothing(beam) ? std::numeric_limits<double>::infinity() : std::numeric_limits<double>::quiet_NaN();
}

/// A cylinder where there are no `points`, else a line along them.
void marker(CdrWriter& out, const Track& track, Time time, const char* space, std::span<const Vec2> points) {
  constexpr int kCylinder = 3, kLineStrip = 4, kAdd = 0;
  constexpr double kLineM = 0.05;
  const bool is_line = !points.empty();
  header(out, time, "map");
  out.text(space).i32(track.id).i32(is_line ? kLineStrip : kCylinder).i32(kAdd);
  const Vec2 at = is_line ? Vec2{} : track.position_in_map;  // a line's points are map coordinates already
  pose(out, {at.x, at.y, is_line ? 0.0 : std::atan2(track.velocity_in_map.y, track.velocity_in_map.x)});
  vector(out, is_line ? kLineM : 2.0 * track.radius_m, 2.0 * track.radius_m, 1.0);
  out.f32(track.moving ? 0.8 : 0.4).f32(track.moving ? 0.3 : 0.4).f32(track.moving ? 0.2 : 0.5).f32(0.8);
  out.i32(0).u32(300'000'000).u8(0);  // it fades when no scan renews it
  out.u32(points.size());
  for (const Vec2 p : points) vector(out, p.x, p.y, 0.0);
  out.u32(0).text("");                           // no colours, texture
  header(out, Time{}, "");                       // texture: none
  out.text("").u32(0).u32(0).text("").text("");  // nor coordinates on it, text, mesh
  out.text("").u32(0).u8(0);
}

/// sensor_msgs/PointCloud2 of the hits, in the laser's frame.
void points(CdrWriter& out, const LaserScan& scan, Time time, const std::string& frame) {
  constexpr unsigned kFloat32 = 7;
  constexpr std::size_t kPointBytes = 12;
  CdrWriter data;  // for its numbers alone
  std::size_t hits = 0;
  for (std::size_t k = 0; k < scan.beam_count; ++k) {
    if (!scan.is_hit(k)) continue;
    const Vec2 p = direction(scan.angle_rad(k)) * static_cast<double>(scan.range_m[k]);
    data.f32(p.x).f32(p.y).f32(0.0);
    ++hits;
  }
  header(out, time, frame);
  out.u32(1).u32(hits).u32(3);
  std::size_t offset = 0;
  for (const char* axis : {"x", "y", "z"}) {
    out.text(axis).u32(offset).u8(kFloat32).u32(1);
    offset += sizeof(float);
  }
  out.u8(0).u32(kPointBytes).u32(kPointBytes * hits).bytes(std::string_view(data.message()).substr(4)).u8(1);
}

/// nav_msgs/Odometry: the wheels' pose in odom, and their speed.
void odometry(CdrWriter& out, const RobotFrames& frames, const WheelState& wheels, const DriveModel& drive, Time time) {
  header(out, time, "odom");
  out.text("base_link");
  pose(out, frames.odom_from_robot);
  covariance(out);
  const double left = drive.wheel_radius_m * wheels.left_radps, right = drive.wheel_radius_m * wheels.right_radps;
  twist(out, {0.5 * (left + right), (right - left) / drive.track_width_m});
  covariance(out);
}

/// tf2_msgs/TFMessage: map to odom, odom to base_link.
void transforms(CdrWriter& out, const RobotFrames& frames, Time time) {
  out.u32(2);
  transform(out, time, "map", "odom", frames.map_from_odom);
  transform(out, time, "odom", "base_link", frames.odom_from_robot);
}

/// tf2_msgs/TFMessage: base_link to each laser.
void static_transforms(CdrWriter& out, const RobotModel& model, Time time) {
  const OfEach<LaserModel> lasers = model.lasers();
  out.u32(static_cast<std::uint32_t>(lasers.size()));
  for (std::size_t k = 0; k < lasers.size(); ++k)
    transform(out, time, "base_link", of_scanner("laser", model, k), lasers[k].robot_from_laser);
}

/// geometry_msgs/PoseStamped.
void goal_pose(CdrWriter& out, const OperatorInput& input, Time time) {
  header(out, time, "map");
  const double heading = input.wants_heading() ? input.goal_heading_rad : 0.0;
  pose(out, {input.goal_in_map.x, input.goal_in_map.y, heading});
}

/// nav_msgs/Path.
void path(CdrWriter& out, const PlannedPath& path, Time time) {
  header(out, time, "map");
  out.u32(path.points.size());
  for (std::size_t k = 0; k < path.points.size(); ++k) {
    const Vec2 here = in_metres(path.points[k]),
               ahead = in_metres(path.points[std::min(k + 1, path.points.size() - 1)]);
    header(out, time, "map");
    pose(out, {here.x, here.y, std::atan2(ahead.y - here.y, ahead.x - here.x)});
  }
}

/// visualization_msgs/MarkerArray: a cylinder a track, red where it moves, and a line ("expected") to where it will be
/// in 2.5 s if it goes straight on.
void tracks(CdrWriter& out, std::span<const Track> tracks, Time stamp) {
  constexpr double kAheadS = 2.5;
  const auto moving = std::count_if(tracks.begin(), tracks.end(), [](const Track& t) { return t.moving; });
  out.u32(tracks.size() + static_cast<std::size_t>(moving));
  for (const Track& track : tracks) {
    marker(out, track, stamp, "tracks", {});
    const std::array line{track.position_in_map, track.position_in_map + track.velocity_in_map * kAheadS};
    if (track.moving) marker(out, track, stamp, "expected", line);
  }
}

/// diagnostic_msgs/DiagnosticArray: reasons, plan, gap.
void diagnostics(CdrWriter& out, const TickRecord& tick, Time time) {
  constexpr unsigned kOk = 0, kWarn = 1, kError = 2;
  const std::string reasons = to_string(tick.verdict.reasons, tick.verdict.faulty_scanners);
  header(out, time, "");
  out.u32(1).u8(has(tick.verdict.reasons, Reason::kLatched) ? kError : reasons.empty() ? kOk : kWarn);
  out.text("jaywalk supervisor").text(reasons.empty() ? "drives as planned" : reasons).text("").u32(2);
  out.text("plan").text(name_of(tick.plan_status)).text("gap_m").text(formatted("%.3f", tick.verdict.gap_m));
}

/// nav_msgs/OccupancyGrid of what is known: 100 occupied, 0 seen free, -1 unknown.
std::string occupancy(const EvidenceMap& map, Time time) {
  CellIndex low{map.low().i + map.side(), map.low().j + map.side()}, high{map.low().i - 1, map.low().j - 1};
  const auto state = [&](CellIndex c) { return map.occupied(c) ? 100 : map.seen_free(c) ? 0 : -1; };
  for (std::int32_t j = map.low().j; j < map.low().j + map.side(); ++j) {
    for (std::int32_t i = map.low().i; i < map.low().i + map.side(); ++i) {
      if (state({i, j}) < 0) continue;
      low = {std::min(low.i, i), std::min(low.j, j)};
      high = {std::max(high.i, i), std::max(high.j, j)};
    }
  }
  if (high.i < low.i) return "";
  std::string cells;
  for (std::int32_t j = low.j; j <= high.j; ++j)
    for (std::int32_t i = low.i; i <= high.i; ++i) cells += static_cast<char>(state({i, j}));
  CdrWriter out;
  header(out, time, "map");
  stamp(out, time);
  out.f32(map.cell_m())
      .u32(static_cast<std::size_t>(high.i - low.i + 1))
      .u32(static_cast<std::size_t>(high.j - low.j + 1));
  pose(out, {low.i * map.cell_m(), low.j * map.cell_m(), 0.0});
  out.bytes(cells);
  return out.message();
}

constexpr std::uint32_t bit(RosTopicNumber topic) { return 1U << topic; }

bool same_heading(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

}  // namespace

std::string laser_scan(const LaserScan& scan, Time time, const std::string& frame) {
  CdrWriter out;
  header(out, time, frame);
  const double step = static_cast<double>(scan.angle_step_rad), beams = std::max(1.0, scan.beam_count - 1.0);
  out.f32(scan.angle_rad(0)).f32(scan.angle_rad(scan.beam_count - 1U)).f32(step);
  out.f32(to_seconds(scan.sweep) / beams).f32(to_seconds(scan.period));
  out.f32(static_cast<double>(scan.range_min_m)).f32(static_cast<double>(scan.range_max_m)).u32(scan.beam_count);
  for (std::size_t k = 0; k < scan.beam_count; ++k) out.f32(range_of(scan, k));
  out.u32(0);  // intensities
  return out.message();
}

std::string of_scanner(const std::string& word, const RobotModel& model, std::size_t scanner) {
  const std::string name = scanner_name(model, scanner);
  return name.empty() ? word : word + "_" + name;
}

std::vector<NamedTopic> topics_of(const RobotModel& model) {
  std::vector<NamedTopic> topics;
  for (const RosTopic& topic : kRosTopics) topics.push_back({topic.name, topic.type});
  topics[kScan].name = of_scanner("/scan", model, 0);
  for (std::size_t k = 1; k < model.lasers().size(); ++k)
    topics.push_back({of_scanner("/scan", model, k), kRosTopics[kScan].type});
  return topics;
}

template <class Write, class... Parts>
void RosTopics::say(RosTopicNumber topic, Time time, Write write, const Parts&... parts) {
  if (!wants(topic)) return;
  CdrWriter out;
  write(out, parts...);
  push_(topic, time, out.message());
}

void RosTopics::forget(std::uint32_t topics) {
  if ((topics & (bit(kScan) | bit(kPoints) | bit(kTracks))) != 0) scans_seen_[0] = 0;
  if ((topics & bit(kPlan)) != 0) plan_seen_ = kNever;
  if ((topics & bit(kGoal)) != 0) goal_seen_ = {};
  if ((topics & bit(kMap)) != 0) mapped_ = kNever;
  if ((topics & bit(kTfStatic)) != 0) told_static_ = false;
}

/// Without wheels odom is the map.
RobotFrames RosTopics::frames_at(const TickRecord& t, const RobotModel& model) {
  if (!odometry_) odometry_.emplace(model.drive);
  if (t.wheels.sequence == 0) return {{}, t.pose.map_from_robot};
  if (t.wheels.stamp != odometry_->stamp()) (void)odometry_->take(t.wheels);
  const Pose2 odom_from_robot = odometry_->odom_from_robot();
  return {t.pose.map_from_robot * inverse(odom_from_robot), odom_from_robot};
}

void RosTopics::add(const TickRecord& t, std::span<const Track> tracks, const PlannedPath& path,
                    const RobotModel& model, std::uint32_t wanted) {
  forget(wanted & ~wanted_);
  wanted_ = wanted;
  if (wanted == 0) return;
  const Time now = wall(t.now);
  const RobotFrames frames = frames_at(t, model);
  if (wants(kTfStatic) && !std::exchange(told_static_, true)) say(kTfStatic, now, static_transforms, model, now);
  say(kClock, now, stamp, now);
  say(kTf, now, transforms, frames, now);
  say(kOdom, now, odometry, frames, t.wheels, model.drive, now);
  say(kCmdVel, now, twist, t.verdict.permitted);
  add_scans(t, tracks, model);
  if (wants(kPlan) && !path.points.empty() && path.stamp != plan_seen_) {
    say(kPlan, now, exchange::path, path, wall(path.stamp));
    plan_seen_ = path.stamp;
  }
  add_goal(t);
  if (wants(kDiagnostics)) add_diagnostics(t);
}

void RosTopics::add_scans(const TickRecord& t, std::span<const Track> tracks, const RobotModel& model) {
  const Time now = wall(t.now);
  for (std::size_t k = 0; k < t.scans().size(); ++k) {
    const LaserScan& scan = t.scans()[k];
    if (std::exchange(scans_seen_[k], scan.sequence) == scan.sequence || scan.beam_count == 0) continue;
    const std::string frame = of_scanner("laser", model, k);
    const std::size_t topic = k == 0 ? std::size_t{kScan} : kOtherScans + k - 1;
    if (wants(topic)) push_(topic, now, laser_scan(scan, wall(scan.stamp), frame));
    if (k > 0) continue;
    say(kPoints, now, points, scan, wall(scan.stamp), frame);
    say(kTracks, now, exchange::tracks, tracks, now);
  }
}

void RosTopics::add_goal(const TickRecord& t) {
  const OperatorInput &now = t.input, &before = goal_seen_;
  const bool same =
      now.goal_in_map == before.goal_in_map && same_heading(now.goal_heading_rad, before.goal_heading_rad);
  if (now.has_goal && !(before.has_goal && same)) say(kGoal, wall(t.now), goal_pose, now, wall(t.now));
  goal_seen_ = now;
}

void RosTopics::add_diagnostics(const TickRecord& t) {
  const bool is_due = told_ == kNever || age(told_, t.now) >= kDiagnosticsEvery;
  if (!is_due && t.verdict.reasons == reasons_) return;
  say(kDiagnostics, wall(t.now), diagnostics, t, wall(t.now));
  reasons_ = t.verdict.reasons;
  told_ = t.now;
}

bool RosTopics::is_map_due(Time now, std::uint32_t wanted) const {
  return (wanted & bit(kMap)) != 0 && (mapped_ == kNever || age(mapped_, now) >= kMapEvery);
}

void RosTopics::add_map(const EvidenceMap& map, Time now) {
  std::string message = occupancy(map, wall(now));
  if (message.empty()) return;
  push_(kMap, wall(now), std::move(message));
  mapped_ = now;
}

}  // namespace jaywalk::exchange
