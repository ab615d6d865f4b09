#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <sstream>
#include <vector>

#include "apps/formats/ros_topics.h"
#include "apps/formats/wire_reader.h"
#include "hal/shown_text.h"

namespace jaywalk::exchange {
namespace {

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
void rotation(CdrWriter& out, double heading) {
  out.f64(0.0).f64(0.0).f64(std::sin(0.5 * heading)).f64(std::cos(0.5 * heading));
}
void pose(CdrWriter& out, const Pose2& p) {
  vector(out, p.x, p.y, 0.0);
  rotation(out, p.heading);
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
  vector(out, p.x, p.y, 0.0);
  rotation(out, p.heading);
}
/// As REP 117 has it.
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

void value(CdrWriter& out, const char* key, const std::string& said) { out.text(key).text(said); }

const std::map<std::string, std::string>& fields() {
  static const std::map<std::string, std::string> all{
      {"builtin_interfaces/Time", "int32 sec\nuint32 nanosec\n"},
      {"builtin_interfaces/Duration", "int32 sec\nuint32 nanosec\n"},
      {"std_msgs/Header", "builtin_interfaces/Time stamp\nstring frame_id\n"},
      {"std_msgs/ColorRGBA", "float32 r\nfloat32 g\nfloat32 b\nfloat32 a\n"},
      {"geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z\n"},
      {"geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z\n"},
      {"geometry_msgs/Quaternion", "float64 x\nfloat64 y\nfloat64 z\nfloat64 w\n"},
      {"geometry_msgs/Pose", "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n"},
      {"geometry_msgs/PoseStamped", "std_msgs/Header header\ngeometry_msgs/Pose pose\n"},
      {"geometry_msgs/PoseWithCovariance", "geometry_msgs/Pose pose\nfloat64[36] covariance\n"},
      {"geometry_msgs/Twist", "geometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular\n"},
      {"geometry_msgs/TwistWithCovariance", "geometry_msgs/Twist twist\nfloat64[36] covariance\n"},
      {"geometry_msgs/Transform", "geometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n"},
      {"geometry_msgs/TransformStamped",
       "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform transform\n"},
      {"tf2_msgs/TFMessage", "geometry_msgs/TransformStamped[] transforms\n"},
      {"nav_msgs/Odometry",
       "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/PoseWithCovariance pose\n"
       "geometry_msgs/TwistWithCovariance twist\n"},
      {"nav_msgs/Path", "std_msgs/Header header\ngeometry_msgs/PoseStamped[] poses\n"},
      {"nav_msgs/MapMetaData",
       "builtin_interfaces/Time map_load_time\nfloat32 resolution\nuint32 width\nuint32 height\n"
       "geometry_msgs/Pose origin\n"},
      {"nav_msgs/OccupancyGrid", "std_msgs/Header header\nnav_msgs/MapMetaData info\nint8[] data\n"},
      {"sensor_msgs/LaserScan",
       "std_msgs/Header header\nfloat32 angle_min\nfloat32 angle_max\nfloat32 angle_increment\nfloat32 time_increment\n"
       "float32 scan_time\nfloat32 range_min\nfloat32 range_max\nfloat32[] ranges\nfloat32[] intensities\n"},
      {"sensor_msgs/PointField",
       "uint8 INT8=1\nuint8 UINT8=2\nuint8 INT16=3\nuint8 UINT16=4\nuint8 INT32=5\nuint8 UINT32=6\nuint8 FLOAT32=7\n"
       "uint8 FLOAT64=8\nstring name\nuint32 offset\nuint8 datatype\nuint32 count\n"},
      {"sensor_msgs/PointCloud2",
       "std_msgs/Header header\nuint32 height\nuint32 width\nsensor_msgs/PointField[] fields\nbool is_bigendian\n"
       "uint32 point_step\nuint32 row_step\nuint8[] data\nbool is_dense\n"},
      {"sensor_msgs/CompressedImage", "std_msgs/Header header\nstring format\nuint8[] data\n"},
      {"visualization_msgs/UVCoordinate", "float32 u\nfloat32 v\n"},
      {"visualization_msgs/MeshFile", "string filename\nuint8[] data\n"},
      {"visualization_msgs/Marker",
       "int32 ARROW=0\nint32 CUBE=1\nint32 SPHERE=2\nint32 CYLINDER=3\nint32 LINE_STRIP=4\nint32 LINE_LIST=5\n"
       "int32 CUBE_LIST=6\nint32 SPHERE_LIST=7\nint32 POINTS=8\nint32 TEXT_VIEW_FACING=9\nint32 MESH_RESOURCE=10\n"
       "int32 TRIANGLE_LIST=11\nint32 ADD=0\nint32 MODIFY=0\nint32 DELETE=2\nint32 DELETEALL=3\n"
       "std_msgs/Header header\nstring ns\nint32 id\nint32 type\nint32 action\ngeometry_msgs/Pose pose\n"
       "geometry_msgs/Vector3 scale\nstd_msgs/ColorRGBA color\nbuiltin_interfaces/Duration lifetime\nbool "
       "frame_locked\n"
       "geometry_msgs/Point[] points\nstd_msgs/ColorRGBA[] colors\nstring texture_resource\n"
       "sensor_msgs/CompressedImage texture\nvisualization_msgs/UVCoordinate[] uv_coordinates\nstring text\n"
       "string mesh_resource\nvisualization_msgs/MeshFile mesh_file\nbool mesh_use_embedded_materials\n"},
      {"visualization_msgs/MarkerArray", "visualization_msgs/Marker[] markers\n"},
      {"rosgraph_msgs/Clock", "builtin_interfaces/Time clock\n"},
      {"diagnostic_msgs/KeyValue", "string key\nstring value\n"},
      {"diagnostic_msgs/DiagnosticStatus",
       "byte OK=0\nbyte WARN=1\nbyte ERROR=2\nbyte STALE=3\nbyte level\nstring name\nstring message\n"
       "string hardware_id\ndiagnostic_msgs/KeyValue[] values\n"},
      {"diagnostic_msgs/DiagnosticArray", "std_msgs/Header header\ndiagnostic_msgs/DiagnosticStatus[] status\n"},
  };
  return all;
}

/// The types in `type`, each once, before those in them.
void collect(const std::string& type, std::vector<std::string>& found) {
  std::istringstream lines(fields().at(type));
  for (std::string line; std::getline(lines, line);) {
    const std::string field = line.substr(0, line.find_first_of("[ "));
    if (field.find('/') == std::string::npos) continue;
    bool known = false;
    for (const std::string& other : found) known = known || other == field;
    if (known) continue;
    found.push_back(field);
    collect(field, found);
  }
}

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

std::string points(const LaserScan& scan, Time time, const std::string& frame) {
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
  CdrWriter out;
  header(out, time, frame);
  out.u32(1).u32(hits).u32(3);
  std::size_t offset = 0;
  for (const char* axis : {"x", "y", "z"}) {
    out.text(axis).u32(offset).u8(kFloat32).u32(1);
    offset += sizeof(float);
  }
  out.u8(0).u32(kPointBytes).u32(kPointBytes * hits).bytes(std::string_view(data.message()).substr(4)).u8(1);
  return out.message();
}

std::string odometry(const RobotFrames& frames, const WheelState& wheels, const DriveModel& drive, Time time) {
  CdrWriter out;
  header(out, time, "odom");
  out.text("base_link");
  pose(out, frames.odom_from_robot);
  covariance(out);
  const double left = drive.wheel_radius_m * wheels.left_radps, right = drive.wheel_radius_m * wheels.right_radps;
  twist(out, {0.5 * (left + right), (right - left) / drive.track_width_m});
  covariance(out);
  return out.message();
}

std::string transforms(const RobotFrames& frames, Time time) {
  CdrWriter out;
  out.u32(2);
  transform(out, time, "map", "odom", frames.map_from_odom);
  transform(out, time, "odom", "base_link", frames.odom_from_robot);
  return out.message();
}

std::string static_transforms(const RobotModel& model, Time time) {
  CdrWriter out;
  const OfEach<LaserModel> lasers = model.lasers();
  out.u32(static_cast<std::uint32_t>(lasers.size()));
  for (std::size_t k = 0; k < lasers.size(); ++k)
    transform(out, time, "base_link", of_scanner("laser", model, k), lasers[k].robot_from_laser);
  return out.message();
}

std::string of_scanner(const std::string& word, const RobotModel& model, std::size_t scanner) {
  const std::string name = scanner_name(model, scanner);
  return name.empty() ? word : word + "_" + name;
}

std::string command(const TickRecord& tick) {
  CdrWriter out;
  twist(out, tick.verdict.permitted);
  return out.message();
}

std::string goal_pose(const OperatorInput& input, Time time) {
  CdrWriter out;
  header(out, time, "map");
  const double heading = input.wants_heading() ? input.goal_heading_rad : 0.0;
  pose(out, {input.goal_in_map.x, input.goal_in_map.y, heading});
  return out.message();
}

std::string path(const PlannedPath& path, Time time) {
  CdrWriter out;
  header(out, time, "map");
  out.u32(path.points.size());
  for (std::size_t k = 0; k < path.points.size(); ++k) {
    const Vec2 here = in_metres(path.points[k]),
               ahead = in_metres(path.points[std::min(k + 1, path.points.size() - 1)]);
    header(out, time, "map");
    pose(out, {here.x, here.y, std::atan2(ahead.y - here.y, ahead.x - here.x)});
  }
  return out.message();
}

std::string tracks(std::span<const Track> tracks, Time stamp) {
  constexpr double kAheadS = 2.5;
  CdrWriter out;
  const auto moving = std::count_if(tracks.begin(), tracks.end(), [](const Track& t) { return t.moving; });
  out.u32(tracks.size() + static_cast<std::size_t>(moving));
  for (const Track& track : tracks) {
    marker(out, track, stamp, "tracks", {});
    const std::array line{track.position_in_map, track.position_in_map + track.velocity_in_map * kAheadS};
    if (track.moving) marker(out, track, stamp, "expected", line);
  }
  return out.message();
}

std::string clock(Time now) {
  CdrWriter out;
  stamp(out, now);
  return out.message();
}

std::string diagnostics(const TickRecord& tick, Time time) {
  constexpr unsigned kOk = 0, kWarn = 1, kError = 2;
  const std::string reasons = to_string(tick.verdict.reasons, tick.verdict.faulty_scanners);
  const std::string gap = formatted("%.3f", tick.verdict.gap_m);
  CdrWriter out;
  header(out, time, "");
  out.u32(1).u8(has(tick.verdict.reasons, Reason::kLatched) ? kError : reasons.empty() ? kOk : kWarn);
  out.text("jaywalk supervisor").text(reasons.empty() ? "drives as planned" : reasons).text("").u32(2);
  value(out, "plan", name_of(tick.plan_status));
  value(out, "gap_m", gap);
  return out.message();
}

std::string occupancy(const EvidenceMap& map, Time time) {
  CellIndex low = map.low(), high{low.i - 1, low.j - 1};
  bool any = false;
  const auto state = [&](CellIndex c) { return map.occupied(c) ? 100 : map.seen_free(c) ? 0 : -1; };
  for (std::int32_t j = map.low().j; j < map.low().j + map.side(); ++j) {
    for (std::int32_t i = map.low().i; i < map.low().i + map.side(); ++i) {
      if (state({i, j}) < 0) continue;
      low = any ? CellIndex{std::min(low.i, i), std::min(low.j, j)} : CellIndex{i, j};
      high = any ? CellIndex{std::max(high.i, i), std::max(high.j, j)} : CellIndex{i, j};
      any = true;
    }
  }
  if (!any) return "";
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

std::string ros_schema(const std::string& type) {
  const std::string name = type.substr(0, type.find("/msg/")) + type.substr(type.find("/msg/") + 4);
  std::vector<std::string> parts;
  collect(name, parts);
  std::string text = fields().at(name);
  for (const std::string& part : parts) text += std::string(80, '=') + "\nMSG: " + part + "\n" + fields().at(part);
  return text;
}

}  // namespace jaywalk::exchange
