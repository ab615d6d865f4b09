#include "apps/report/picture/run_layers.h"

#include <algorithm>
#include <limits>

namespace jaywalk {
namespace {
constexpr double kTrailFadeS = 12.0;        ///< a trail is e times fainter after this
constexpr double kStepM = 0.7;              ///< a track that stays within this went nowhere
constexpr double kOutlineEveryM = 1.5;      ///< travel between two outlines of the robot
constexpr double kLabelApartPixels = 46.0;  ///< between two times written along the drive

constexpr double kWallStepM = 0.05;  ///< between two places that are looked at for walls
constexpr double kBodyM = 0.15;      ///< a body is at least this far across from its middle

double gap_to_walls(const PictureScene& scene, Vec2 p) {
  double gap = std::numeric_limits<double>::infinity();
  for (const sim::WallSegment& wall : scene.walls) gap = std::min(gap, distance(p, wall));
  if (!scene.walls.empty()) return gap;  // cells seen occupied may be the mover's own, while it stood
  for (const Vec2 cell : scene.occupied) gap = std::min(gap, distance(p, cell));
  return gap;
}

Polyline outline(const Pose2& pose, const Footprint& f, const MapFrame& to_sheet) {
  const Transform2 map_from_robot(pose);
  Polyline corners;
  for (const Vec2 corner : {Vec2{f.front_m, f.half_width_m}, Vec2{-f.rear_m, f.half_width_m},
                            Vec2{-f.rear_m, -f.half_width_m}, Vec2{f.front_m, -f.half_width_m}}) {
    corners.push_back(to_sheet(map_from_robot * corner));
  }
  return corners;
}

void draw_robot(Canvas& canvas, const MapFrame& to_sheet, const Pose2& pose, const Footprint& footprint,
                double opacity) {
  const Polyline corners = outline(pose, footprint, to_sheet);
  canvas.fill(corners, ink::kRobot.faded(0.25 * opacity));
  canvas.stroke(corners, {ink::kRobot.faded(opacity), 1.2 * weight_of(to_sheet)}, true);
  const Vec2 nose = pose * Vec2{footprint.front_m, 0.0};
  canvas.stroke({to_sheet(pose.position()), to_sheet(nose)}, {ink::kRobot.faded(opacity), 1.2 * weight_of(to_sheet)});
}

/// Writes with a white rim, so that it reads on any ground.
void write_on_map(Canvas& canvas, Vec2 at, const std::string& text, const Lettering& lettering) {
  Lettering rim = lettering;
  rim.colour = colour(0xFFFFFF).faded(0.6);
  for (const Vec2 shift : {Vec2{1.5, 0}, Vec2{-1.5, 0}, Vec2{0, 1.5}, Vec2{0, -1.5}})
    canvas.write(at + shift, text, rim);
  canvas.write(at, text, lettering);
}

/// A round number of seconds that puts at most about a dozen marks on the drive.
double label_step_s(double duration_s) {
  for (const double step : {1.0, 2.0, 5.0, 10.0, 20.0, 30.0, 60.0, 120.0, 300.0, 600.0}) {
    if (duration_s / step <= 12.0) return step;
  }
  return 1800.0;
}

void draw_times(Canvas& canvas, const MapFrame& to_sheet, const std::vector<DrivenPose>& driven) {
  const double step_s = label_step_s(to_seconds(driven.back().t - driven.front().t));
  double next_s = step_s;
  std::vector<Vec2> written;
  for (const DrivenPose& d : driven) {
    const double since_start_s = to_seconds(d.t - driven.front().t);
    if (since_start_s + 1e-6 < next_s) continue;
    const Vec2 at = to_sheet(d.pose.position());
    canvas.draw_disc(at, 3.6 * weight_of(to_sheet), colour(0xFFFFFF), {ink::kRobot, 1.6 * weight_of(to_sheet)});
    const bool crowded = std::ranges::any_of(written, [&](Vec2 p) { return distance(at, p) < kLabelApartPixels; });
    if (!crowded) {
      const std::string text = std::to_string(static_cast<int>(next_s)) + " s";
      write_on_map(canvas, at + Vec2{9.0, -9.0}, text, {17.0, ink::kRobot});
      written.push_back(at);
    }
    while (next_s <= since_start_s + 1e-6) next_s += step_s;
  }
}

void draw_trail(Canvas& canvas, const MapFrame& to_sheet, const Trail& trail, Time end) {
  const Colour own = colour_of(trail.id);
  for (std::size_t i = 1; i < trail.points.size() && trail.points[i].t <= end; ++i) {
    const double age_s = to_seconds(end - trail.points[i].t);
    const double opacity = 0.10 + 0.75 * exp(-age_s / kTrailFadeS);
    canvas.stroke({to_sheet(trail.points[i - 1].position), to_sheet(trail.points[i].position)},
                  {own.faded(opacity), 2.4 * weight_of(to_sheet)});
  }
}

void draw_body(Canvas& canvas, const MapFrame& to_sheet, const Trail& trail, Vec2 at_in_map) {
  const Vec2 at = to_sheet(at_in_map);
  const double radius = to_sheet.pixels(std::max(trail.radius_m, 0.1));
  canvas.draw_disc(at, radius, colour_of(trail.id).faded(0.85),
                   {trail.flagged ? ink::kForced : ink::kText, (trail.flagged ? 3.0 : 1.2) * weight_of(to_sheet)});
  const double size = std::clamp(radius * 1.1, 9.0, 18.0);
  canvas.write(at + Vec2{0.0, size * 0.36}, std::to_string(trail.id), {size, colour(0xFFFFFF), Align::kCentre, true});
}

}  // namespace

Colour colour_of(std::uint32_t id) {
  // Told apart by most kinds of colour vision, and none of them the robot's, the goal's or the plan's.
  constexpr std::array<Colour, 8> kColours{colour(0x7A4EA8), colour(0x2F8FB3), colour(0xB8478C), colour(0x8A6D1F),
                                           colour(0x4F5DC4), colour(0x3E8E7E), colour(0x9C5238), colour(0x66707F)};
  return kColours[id % kColours.size()];
}

double weight_of(const MapFrame& to_sheet) { return std::clamp(to_sheet.pixels(1.0) / 50.0, 0.6, 1.6); }

Colour colour_of(ZoneKind kind) { return kind == ZoneKind::kKeepOut ? ink::kKeepOut : ink::kSlow; }

void draw_zones(Canvas& canvas, const MapFrame& to_sheet, const PictureScene& scene) {
  for (const MapZone& zone : scene.zones) {
    const Polyline corners = on_sheet(zone.corners, to_sheet);
    canvas.fill(corners, colour_of(zone.kind).faded(0.18));
    canvas.stroke(corners, {colour_of(zone.kind), 2.0 * weight_of(to_sheet), 8.0}, true);
  }
}

void draw_walls(Canvas& canvas, const MapFrame& to_sheet, const PictureScene& scene) {
  const double seen = to_sheet.pixels(scene.cell_m);
  const double drawn = seen + 0.6;  // neighbours overlap, else light shines through between them
  for (const sim::WallSegment& wall : scene.walls) {
    canvas.stroke({to_sheet(wall.from), to_sheet(wall.to)}, {ink::kWall, std::max(2.0, 0.8 * seen)});
  }
  for (const Vec2 cell : scene.occupied) {
    const Vec2 low = to_sheet(cell - Vec2{scene.cell_m / 2.0, scene.cell_m / 2.0});
    canvas.fill({low, low + Vec2{drawn, 0.0}, low + Vec2{drawn, -drawn}, low + Vec2{0.0, -drawn}}, ink::kSeen);
  }
}

bool went_somewhere(const Trail& track) {
  return track.flagged && std::any_of(track.points.begin(), track.points.end(), [&](const TrailPoint& p) {
           return distance(p.position, track.points.front().position) > kStepM;
         });
}

void draw_tracks(Canvas& canvas, const MapFrame& to_sheet, const std::vector<Trail>& tracks) {
  const double weight = weight_of(to_sheet);
  for (const Trail& track : tracks) {
    if (!went_somewhere(track)) continue;
    Polyline line;
    for (const TrailPoint& p : track.points) line.push_back(to_sheet(p.position));
    canvas.stroke(line, {colour_of(track.id).faded(0.85), 2.6 * weight});
    canvas.fill_disc(line.back(), 5.0 * weight, colour_of(track.id));
    write_on_map(canvas, line.back() + Vec2{7.0, 5.0}, std::to_string(track.id),
                 {14.0, colour_of(track.id), Align::kLeft, true});
  }
}

void draw_movers(Canvas& canvas, const MapFrame& to_sheet, const std::vector<Trail>& movers, Time t) {
  for (const Trail& trail : movers) draw_trail(canvas, to_sheet, trail, t);
  for (const Trail& trail : movers) {
    if (const auto at = position_at(trail, t)) draw_body(canvas, to_sheet, trail, *at);
  }
}

void draw_drive(Canvas& canvas, const MapFrame& to_sheet, const PictureScene& scene) {
  if (scene.driven.empty()) return;
  Polyline line;
  double since_outline_m = kOutlineEveryM;
  for (std::size_t i = 0; i < scene.driven.size(); ++i) {
    const DrivenPose& here = scene.driven[i];
    if (i > 0) since_outline_m += distance(scene.driven[i - 1].pose.position(), here.pose.position());
    if (since_outline_m >= kOutlineEveryM) {
      draw_robot(canvas, to_sheet, here.pose, scene.footprint, 0.35);
      since_outline_m = 0.0;
    }
    line.push_back(to_sheet(here.pose.position()));
  }
  canvas.stroke(line, {colour(0xFFFFFF).faded(0.7), 6.0 * weight_of(to_sheet)});
  canvas.stroke(line, {ink::kRobot, 3.6 * weight_of(to_sheet)});
  draw_robot(canvas, to_sheet, scene.driven.back().pose, scene.footprint, 1.0);
  draw_times(canvas, to_sheet, scene.driven);
}

Vec2 end_before_wall(const PictureScene& scene, Vec2 from, Vec2 to, double radius_m) {
  const double length = distance(from, to);
  if (!(length > 0.0)) return to;
  Vec2 reached = from;
  for (double way = 0.0; way < length; way += kWallStepM) {
    const Vec2 here = from + (to - from) * (way / length);
    if (gap_to_walls(scene, here) < radius_m) return reached;
    reached = here;
  }
  return gap_to_walls(scene, to) < radius_m ? reached : to;
}

void draw_moment(Canvas& canvas, const MapFrame& to_sheet, const PictureScene& scene) {
  if (!scene.moment) return;
  const PlanMoment& moment = *scene.moment;
  const double weight = weight_of(to_sheet);
  for (const Prediction& p : moment.predictions) {
    const auto track = std::ranges::find(moment.tracks, p.track_id, &Track::id);
    const bool known = track != moment.tracks.end();
    const Vec2 at =
        to_sheet(known ? end_before_wall(scene, track->position_in_map, p.position_in_map, kBodyM) : p.position_in_map);
    canvas.draw_disc(at, to_sheet.pixels(p.mark_radius_m), ink::kBand.faded(0.10), {ink::kBand, 1.6 * weight, 6.0});
    if (!known) continue;
    canvas.stroke({to_sheet(track->position_in_map), at}, {ink::kBand.faded(0.8), 1.4 * weight, 3.0});
    canvas.fill_disc(to_sheet(track->position_in_map), 4.0 * weight, ink::kBand);
  }
  canvas.stroke(on_sheet(moment.band, to_sheet), {ink::kBand.faded(0.85), 3.2 * weight, 10.0});
  const Polyline corners = outline(moment.map_from_robot, scene.footprint, to_sheet);
  canvas.fill(corners, ink::kBand.faded(0.35));
  canvas.stroke(corners, {ink::kBand, 2.2 * weight}, true);
}

void draw_ends(Canvas& canvas, const MapFrame& to_sheet, const PictureScene& scene) {
  const double weight = weight_of(to_sheet);
  if (scene.start) {
    const Vec2 at = to_sheet(scene.start->position());
    canvas.fill_disc(at, 7.0 * weight, ink::kRobot);
    write_on_map(canvas, at + Vec2{0.0, 30.0}, "start", {20.0, ink::kRobot, Align::kCentre, true});
  }
  if (scene.goal) {
    const Vec2 at = to_sheet(*scene.goal);
    const double radius = std::max(to_sheet.pixels(scene.goal_tolerance_m), 6.0);
    canvas.draw_disc(at, radius, ink::kGoal.faded(0.25), {ink::kGoal, 3.0 * weight});
    canvas.fill_disc(at, 4.0 * weight, ink::kGoal);
    if (scene.goal_heading_rad) {
      const Vec2 ahead = to_sheet(*scene.goal + direction(*scene.goal_heading_rad)) - at;
      canvas.stroke(Polyline{at, at + ahead * (radius / norm(ahead))}, {ink::kGoal, 3.0 * weight});
    }
    write_on_map(canvas, at + Vec2{0.0, -radius - 10.0}, "goal", {20.0, ink::kGoal, Align::kCentre, true});
  }
}

}  // namespace jaywalk
