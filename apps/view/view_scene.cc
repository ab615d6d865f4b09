#include "apps/view/view_scene.h"

#include <openssl/evp.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "firmware/safety/latency.h"
#include "firmware/safety/reasons.h"
#include "firmware/safety/stop_zone.h"
#include "planner/motion/goal_rollouts.h"
#include "planner/scan/scan_points.h"

namespace jaywalk::view {
namespace {
using Ordered = nlohmann::ordered_json;

constexpr Duration kTakeEvery = std::chrono::milliseconds(40);
constexpr Duration kOfferEvery = std::chrono::milliseconds(500);

template <class T, std::size_t N>
void copy(FixedVector<T, N>& to, std::span<const T> from) noexcept {
  to.clear();
  for (const T& item : from) {
    if (!to.push_back(item)) break;
  }
}

ShownMover shown_mover(const motion::Futures& futures, std::size_t mover) noexcept {
  ShownMover out{.radius_m = futures.movers()[mover].radius_m};
  for (std::size_t step = 0; step < kShownSteps.size(); ++step) {
    const motion::MoverAt& at = futures.at(kShownSteps[step], mover);
    for (std::size_t f = 0; f < kShownFutures; ++f) out.at[f][step] = {at.x[f], at.y[f]};
  }
  return out;
}

constexpr std::uint8_t kNoWay = 254, kNotFree = 255;
constexpr std::uint8_t kNeverSeen = 127;  // added
constexpr double kFarthest = 126.0;

std::uint8_t byte_of(float psi, double most) noexcept {
  if (std::isnan(psi)) return kNotFree;
  if (std::isinf(psi)) return kNoWay;
  return static_cast<std::uint8_t>(std::clamp(kFarthest * static_cast<double>(psi) / most, 0.0, kFarthest));
}

constexpr double kStands_mps = 1e-3;

constexpr std::int32_t kMostGroundSide = 1000;
constexpr std::size_t kZoneParts = 4;
constexpr std::size_t kPathStep = 2;  ///< every second of points 0.05 to 0.2 m apart

/// To the millimetre: the page shows no more.
Ordered mm(double value) {
  return std::isfinite(value) ? Ordered(std::round(value * 1000.0) / 1000.0) : Ordered(nullptr);
}
Ordered cm(float value) { return Ordered(std::round(static_cast<double>(value) * 100.0) / 100.0); }
Ordered place(Vec2 p) { return Ordered::array({mm(p.x), mm(p.y)}); }

/// JSON has bytes of text from files in it: what is no UTF-8 is replaced.
std::string scene_text(const Ordered& json) { return json.dump(-1, ' ', true, Ordered::error_handler_t::replace); }

Ordered hits_of(const ViewSnapshot& snapshot, const OfEach<LaserModel>& lasers) {
  ScanProjection projection;
  ScanPoints points;
  Ordered hits = Ordered::array();
  for (const LaserScan& scan : snapshot.record.scans()) {
    projection.project(scan, lasers[scan.scanner].robot_from_laser, snapshot.twist, points);
    const Transform2 map_from_robot(snapshot.map_from_robot_at_scan[scan.scanner]);
    for (const ScanPoint& point : points) {
      const Vec2 p = map_from_robot * point.in_robot;
      hits.push_back(mm(p.x));
      hits.push_back(mm(p.y));
    }
  }
  return hits;
}

/// An array with `row` of each item.
template <class Items, class Row>
Ordered rows_of(const Items& items, Row row) {
  Ordered out = Ordered::array();
  for (const auto& item : items) out.push_back(row(item));
  return out;
}

/// Position, radius, whether it moves, velocity, whether it ever walked.
Ordered track_row(const Track& k) {
  return Ordered::array({k.id, mm(k.position_in_map.x), mm(k.position_in_map.y), mm(k.radius_m), k.moving ? 1 : 0,
                         mm(k.velocity_in_map.x), mm(k.velocity_in_map.y), k.is_pedestrian ? 1 : 0});
}

/// A mover's radius, then x and y of the first future at each time, of the second, and so on.
Ordered futures_row(const ShownMover& mover) {
  Ordered row = Ordered::array({cm(mover.radius_m)});
  for (const auto& future : mover.at)
    for (const Place& p : future) row.push_back(cm(p.x)), row.push_back(cm(p.y));
  return row;
}

Ordered disc_row(Vec2 place, double radius_m) { return {mm(place.x), mm(place.y), mm(radius_m)}; }

Ordered path_of(const Path& path) {
  Ordered out = Ordered::array();
  for (std::size_t i = 0; i < path.size(); i += kPathStep) out.push_back(place(path[i]));
  return out;
}

/// The supervisor's stop zone: outlines of the body, grown by its margin, where it comes from the twist that was
/// permitted, after the reaction time that the supervisor reckons with, along its arc; the last one is where it stands.
Ordered zone_of(const TickRecord& t, const RobotModel& model, Duration tick) {
  const StopZone zone(stop_zone_for(model, tick));
  const Twist2& twist = t.verdict.permitted;
  const double rim_mps = zone.rim_speed_mps(twist), margin_m = zone.margin_at(rim_mps);
  const double reaction = reaction_s(t.scans(), model, t.now, tick, t.latency);
  const bool stands = rim_mps < kStands_mps;
  const SweptPath way(stands ? Twist2{} : twist, std::max(rim_mps, kStands_mps),
                      stands ? 0.0 : zone.stopping_distance_m(rim_mps, reaction));
  const Footprint& body = model.footprint;
  const double front = body.front_m + margin_m, rear = -body.rear_m - margin_m, side = body.half_width_m + margin_m;
  const std::array<Vec2, 4> corners{{{front, side}, {front, -side}, {rear, -side}, {rear, side}}};
  const Transform2 map_from_robot(t.pose.map_from_robot);
  Ordered outlines = Ordered::array();
  const std::size_t parts = stands ? 1 : kZoneParts;
  for (std::size_t part = 1; part <= parts; ++part) {
    const std::size_t k = way.steps() * part / parts;
    outlines.push_back(rows_of(corners, [&](Vec2 p) { return place(map_from_robot * way.place_of(k, p)); }));
  }
  return outlines;
}

std::string base64_of(std::span<const std::uint8_t> bytes) {
  std::string base64(4 * ((bytes.size() + 2) / 3) + 1, '\0');
  ::EVP_EncodeBlock(reinterpret_cast<unsigned char*>(base64.data()), bytes.data(), static_cast<int>(bytes.size()));
  base64.pop_back();  // a zero behind it
  return base64;
}

/// A byte a cell, rows from the lowest y: 0 unknown, 1 free, 2 with a wall in it. Thinned: walls stay.
Ordered ground_of(const KnownMap& known) {
  std::int32_t step = 1;
  while (std::max(known.width, known.height) > step * kMostGroundSide) ++step;
  const std::int32_t width = (known.width + step - 1) / step, height = (known.height + step - 1) / step;
  std::vector<std::uint8_t> cells(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0);
  for (std::int32_t j = 0; j < known.height; ++j) {
    for (std::int32_t i = 0; i < known.width; ++i) {
      auto& cell = cells[static_cast<std::size_t>(j / step * width + i / step)];
      cell = std::max(cell, static_cast<std::uint8_t>(known.at({known.low.i + i, known.low.j + j})));
    }
  }
  return {{"x", mm(known.low.i * known.cell_m)},
          {"y", mm(known.low.j * known.cell_m)},
          {"cell_m", step * known.cell_m},
          {"width", width},
          {"cells", base64_of(cells)}};
}

/// {"stop_zone": {"says": "something stands in its way", "fault": false}, ...}
Ordered reasons_in_words() {
  Ordered reasons = Ordered::object();
  for (const ReasonRow& row : kReasons)
    reasons[row.name] = {{"says", row.says}, {"fault", !has(kNoFaults, row.reason)}};
  return reasons;
}

}  // namespace

void take(ViewSnapshot& into, const TickRecord& record, const ControlLoop& loop) noexcept {
  into.record = record;
  for (std::size_t k = 0; k < record.scans().size(); ++k)
    into.map_from_robot_at_scan[k] = loop.estimator().map_from_robot_at_scan(k);
  into.twist = loop.estimator().twist();
  copy(into.tracks, loop.tracker().tracks());
  copy(into.standing, loop.tracker().standing());
  into.plan = loop.plan();
  into.movers.clear();
  const motion::GoalRollouts* rollouts = loop.motion().rollouts();
  into.has_chosen = rollouts != nullptr && rollouts->decision().at != kNever;
  if (rollouts == nullptr) return;
  for (std::size_t k = 0; k < into.chosen.size(); ++k) {
    const motion::RobotState& s = rollouts->decision().driven[k * kChosenStep];
    into.chosen[k] = {s.x, s.y};
  }
  const motion::Futures& futures = rollouts->futures();
  for (std::size_t mover = 0; mover < futures.movers().size(); ++mover) {
    if (futures.movers()[mover].is_surface) continue;
    if (!into.movers.push_back(shown_mover(futures, mover))) break;
  }
}

void RunTap::after_tick(const TickRecord& record, const ControlLoop& loop) noexcept {
  if (!wanted_ || (taken_ != kNever && age(taken_, record.now) < kTakeEvery)) return;
  ViewSnapshot* const slot = snapshots_.draft();
  if (slot == nullptr) return;
  take(*slot, record, loop);
  taken_ = record.now;
  snapshots_.publish();
}

void draw(FieldPicture& into, const FieldView& field, const EvidenceMap& seen) noexcept {
  double most = 1e-6;
  for (const float psi : field.psi)
    if (std::isfinite(psi)) most = std::max(most, static_cast<double>(psi));
  std::int32_t step = 1;
  while (std::max(field.width, field.height) > step * kMostFieldSide) step *= 2;
  into.low_x_m = field.low.i * field.cell_m;
  into.low_y_m = field.low.j * field.cell_m;
  into.cell_m = field.cell_m * step;
  into.width = (field.width + step - 1) / step;
  into.cells.clear();
  for (std::int32_t y = 0; y < field.height; y += step) {
    const std::size_t row = static_cast<std::size_t>(y) * static_cast<std::size_t>(field.width);
    for (std::int32_t x = 0; x < field.width; x += step) {
      std::uint8_t byte = byte_of(field.psi[row + static_cast<std::size_t>(x)], most);
      if (byte < kNoWay && seen.evidence({field.low.i + x, field.low.j + y}) == 0) byte += kNeverSeen;
      static_cast<void>(into.cells.push_back(byte));
    }
  }
}

void RunTap::after_plan(const Planner& planner, const EvidenceMap& map, Time stamp) noexcept {
  if (!wanted_ || full_.load(std::memory_order_acquire)) return;
  auto& [field, kept, last] = offer_;
  if (last != kNever && age(last, stamp) < kOfferEvery) return;
  draw(field, planner.view_field(), map);
  kept = map;  // of the same size: no memory is taken
  last = stamp;
  full_.store(true, std::memory_order_release);
}

std::string to_json(const HelloScene& hello, const ControlSetup& setup, bool keeps_ticks) {
  const auto wall = [](const sim::WallSegment& w) {
    return Ordered{mm(w.from.x), mm(w.from.y), mm(w.to.x), mm(w.to.y)};
  };
  const Footprint& body = setup.model.footprint;
  return scene_text({{"kind", "hello"},
                     {"title", hello.title},
                     {"tick_s", to_seconds(setup.tick())},
                     {"takes_goals", hello.takes_goals},
                     {"takes_pauses", hello.takes_pauses},
                     {"keeps_ticks", keeps_ticks},
                     {"front_m", body.front_m},
                     {"rear_m", body.rear_m},
                     {"half_width_m", body.half_width_m},
                     {"max_speed_mps", setup.model.limits.max_speed_mps},
                     {"walls", rows_of(hello.walls, wall)},
                     {"reasons", reasons_in_words()},
                     {"faults", hello.faults},
                     {"ground", hello.known == nullptr ? Ordered(nullptr) : ground_of(*hello.known)}});
}

std::string to_json(const ViewSnapshot& snapshot, const OfEach<LaserModel>& lasers) {
  const auto standing = [](const StandingPedestrian& s) { return disc_row(s.position_in_map, s.radius_m); };
  const auto expected = [](const Prediction& p) { return disc_row(p.position_in_map, p.mark_radius_m); };
  const auto chosen = [](const Place& p) { return Ordered{cm(p.x), cm(p.y)}; };
  const auto none = Ordered::array();
  return scene_text({{"hits", hits_of(snapshot, lasers)},
                     {"tracks", rows_of(snapshot.tracks, track_row)},
                     {"standing", rows_of(snapshot.standing, standing)},
                     {"futures", rows_of(snapshot.movers, futures_row)},
                     {"expected", snapshot.movers.empty() ? rows_of(snapshot.plan.predictions, expected) : none},
                     {"chosen", snapshot.has_chosen ? rows_of(snapshot.chosen, chosen) : none},
                     {"path", path_of(snapshot.plan.path)}});
}

std::string frame_head(const ViewSnapshot& snapshot, std::uint64_t number, const ControlSetup& setup,
                       std::string_view ended) {
  const TickRecord& t = snapshot.record;
  const Pose2& pose = t.pose.map_from_robot;
  Ordered out{{"kind", "frame"},
              {"tick", number},
              {"t", mm(to_seconds(t.now))},
              {"pose", {mm(pose.x), mm(pose.y), mm(pose.heading)}},
              {"wanted", {mm(t.wanted.v_mps), mm(t.wanted.w_radps)}},
              {"permitted", {mm(t.verdict.permitted.v_mps), mm(t.verdict.permitted.w_radps)}},
              {"speed", mm(snapshot.twist.v_mps)},
              {"stops", t.input.stop_orders},
              {"gap_m", mm(t.verdict.gap_m)},
              {"reasons", to_string(t.verdict.reasons, t.verdict.faulty_scanners)},
              {"zone", zone_of(t, setup.model, setup.tick())},
              {"arrived", t.input.has_goal && t.input.is_reached_at(pose)},
              {"ended", ended}};
  if (t.input.has_goal)
    out["goal"] = {mm(t.input.goal_in_map.x), mm(t.input.goal_in_map.y), mm(t.input.goal_heading_rad)};
  std::string text = scene_text(out);
  text.back() = ',';  // for the closing brace
  return text.append("\"scene\":");
}

std::string to_json(const FieldPicture& field, std::uint64_t number) {
  return scene_text({{"kind", "field"},
                     {"number", number},
                     {"x", mm(field.low_x_m)},
                     {"y", mm(field.low_y_m)},
                     {"cell_m", field.cell_m},
                     {"width", field.width},
                     {"cells", base64_of({field.cells.begin(), field.cells.size()})}});
}

}  // namespace jaywalk::view
