#include "firmware/view/view_scene.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "firmware/view/websocket.h"

namespace jaywalk::view {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::int32_t kMostFieldSide = 128;
constexpr std::size_t kPathStep = 2;  ///< every second of points 0.05 to 0.2 m apart

/// To the millimetre: the page shows no more.
Json mm(double value) { return std::isfinite(value) ? Json(std::round(value * 1000.0) / 1000.0) : Json(nullptr); }
Json place(Vec2 p) { return Json::array({mm(p.x), mm(p.y)}); }

/// JSON has bytes of text from files in it: what is no UTF-8 is replaced.
std::string dumped(const Json& json) { return json.dump(-1, ' ', true, Json::error_handler_t::replace); }

Json hits_of(const TickRecord& t, const Pose2& robot_from_laser) {
  const Transform2 map_from_laser(t.pose.map_from_robot * robot_from_laser);
  Json hits = Json::array();
  for (std::size_t i = 0; i < t.scan.beam_count; ++i) {
    if (!t.scan.is_hit(i)) continue;
    const Vec2 p = map_from_laser * (direction(t.scan.angle_rad(i)) * static_cast<double>(t.scan.range_m[i]));
    hits.push_back(mm(p.x));
    hits.push_back(mm(p.y));
  }
  return hits;
}

/// Position, velocity, radius, moves, and variances of the axis for how far its future spreads.
Json tracks_of(std::span<const Track> tracks) {
  Json out = Json::array();
  for (const Track& k : tracks) {
    out.push_back({k.id, mm(k.position_in_map.x), mm(k.position_in_map.y), mm(k.velocity_in_map.x),
                   mm(k.velocity_in_map.y), mm(k.radius_m), k.moving ? 1 : 0, k.covariance.pp, k.covariance.pv,
                   k.covariance.vv});
  }
  return out;
}

Json path_of(const Path& path) {
  Json out = Json::array();
  for (std::size_t i = 0; i < path.size(); i += kPathStep) out.push_back(place(path[i]));
  return out;
}

std::string cell_bytes(const FieldView& field, std::int32_t step, double most) {
  std::string bytes;
  for (std::int32_t y = 0; y < field.height; y += step) {
    for (std::int32_t x = 0; x < field.width; x += step) {
      const float psi =
          field.psi[static_cast<std::size_t>(y) * static_cast<std::size_t>(field.width) + static_cast<std::size_t>(x)];
      const int byte = std::isnan(psi) ? 255
                       : std::isinf(psi)
                           ? 254
                           : std::clamp(static_cast<int>(253.0 * static_cast<double>(psi) / most), 0, 253);
      bytes += static_cast<char>(byte);
    }
  }
  return bytes;
}

}  // namespace

std::string to_json(const HelloScene& hello) {
  Json walls = Json::array();
  for (const WallPiece& w : hello.walls) walls.push_back({mm(w.from.x), mm(w.from.y), mm(w.to.x), mm(w.to.y)});
  const Footprint& body = hello.model.footprint;
  return dumped({{"kind", "hello"},
                 {"title", hello.title},
                 {"takes_goals", hello.takes_goals},
                 {"front_m", body.front_m},
                 {"rear_m", body.rear_m},
                 {"half_width_m", body.half_width_m},
                 {"max_speed_mps", hello.model.limits.max_speed_mps},
                 {"brake_mps2", hello.model.limits.brake_mps2},
                 {"walls", walls}});
}

std::string to_json(const FrameScene& frame, const Pose2& robot_from_laser) {
  const TickRecord& t = frame.record;
  const Pose2& pose = t.pose.map_from_robot;
  Json standing = Json::array();
  for (const Stander& s : frame.standing)
    standing.push_back({mm(s.position_in_map.x), mm(s.position_in_map.y), mm(s.radius_m)});
  Json out{{"kind", "frame"},
           {"t", mm(to_seconds(t.now))},
           {"pose", {mm(pose.x), mm(pose.y), mm(pose.heading)}},
           {"wanted", {mm(t.wanted.v_mps), mm(t.wanted.w_radps)}},
           {"permitted", {mm(t.verdict.permitted.v_mps), mm(t.verdict.permitted.w_radps)}},
           {"gap_m", mm(t.verdict.gap_m)},
           {"reasons", to_string(t.verdict.reasons)},
           {"hits", hits_of(t, robot_from_laser)},
           {"tracks", tracks_of(frame.tracks)},
           {"standing", standing},
           {"path", path_of(frame.plan.path)},
           {"ended", frame.ended}};
  if (t.input.has_goal)
    out["goal"] = {mm(t.input.goal_in_map.x), mm(t.input.goal_in_map.y), mm(t.input.goal_heading_rad)};
  return dumped(out);
}

std::string to_json(const FieldView& field) {
  double most = 1e-6;
  for (const float psi : field.psi)
    if (std::isfinite(psi)) most = std::max(most, static_cast<double>(psi));
  std::int32_t step = 1;
  while (std::max(field.width, field.height) > step * kMostFieldSide) step *= 2;
  const std::int32_t width = (field.width + step - 1) / step;
  return dumped({{"kind", "field"},
                 {"x", mm(field.low.i * field.cell_m)},
                 {"y", mm(field.low.j * field.cell_m)},
                 {"cell_m", field.cell_m * step},
                 {"width", width},
                 {"cells", base64(cell_bytes(field, step, most))}});
}

}  // namespace jaywalk::view
