#include <algorithm>
#include <cmath>

#include "apps/report/markup.h"
#include "apps/report/picture/canvas.h"
#include "apps/report/picture/run_layers.h"
#include "apps/report/picture/scene.h"
#include "hal/shown_text.h"

namespace jaywalk {
namespace {
constexpr double kFactSize = 20.0, kFactLine = 30.0, kLegendLine = 36.0, kSwatch = 52.0;

std::string metres(double value) { return formatted("%.10g", std::floor(value * 10.0 + 0.5) / 10.0); }

std::string moment_time(const PictureScene& scene) {
  const Time begin = scene.driven.empty() ? Time{} : scene.driven.front().t;
  return metres(to_seconds(scene.moment->t - begin)) + " s";
}

/// Samples in a column, each with its words beside it.
struct Legend {
  Canvas& canvas;
  const PictureScene& scene;
  Vec2 at;  ///< left end of the next row

  [[nodiscard]] Vec2 middle() const { return at + Vec2{kSwatch / 2.0, -6.0}; }
  void end_row(const std::string& text) {
    canvas.write(at + Vec2{kSwatch + 22.0, 0.0}, text, {19.0, ink::kText});
    at.y += kLegendLine;
  }
  [[nodiscard]] Polyline across() const {
    return {middle() - Vec2{kSwatch / 2.0, 0.0}, middle() + Vec2{kSwatch / 2.0, 0.0}};
  }
  void add_line(const Pen& pen, const std::string& text) {
    canvas.stroke(across(), pen);
    end_row(text);
  }
  void add_disc(double radius, const Colour& colour, const Pen& rim, const std::string& text) {
    canvas.draw_disc(middle(), radius, colour, rim);
    end_row(text);
  }
  /// A mover's or a track's trail, which ends in a disc.
  void add_trail(double radius, const std::string& text) {
    canvas.stroke(across(), {colour_of(0).faded(0.7), 2.6});
    canvas.fill_disc(middle() + Vec2{kSwatch / 2.0 - radius, 0.0}, radius, colour_of(0));
    end_row(text);
  }
  void add_blank(const std::string& text) {
    const Vec2 mid = middle(), half{kSwatch / 2.0, 9.0};
    canvas.stroke({mid - half, mid + Vec2{half.x, -half.y}, mid + half, mid + Vec2{-half.x, half.y}},
                  {ink::kFaint, 1.2}, true);
    end_row(text);
  }

  void add_map_rows() {
    if (!scene.occupied.empty()) add_line({ink::kSeen, 7.0}, "walls seen");
    if (!scene.walls.empty()) add_line({ink::kWall, 5.0}, "walls");
    for (const auto& [kind, text] : {std::pair{ZoneKind::kKeepOut, "keep-out zone"}, {ZoneKind::kSpeed, "speed zone"}})
      if (std::ranges::count(scene.zones, kind, &MapZone::kind) > 0) add_line({colour_of(kind), 3.0, 8.0}, text);
    if (!scene.driven.empty()) add_line({ink::kRobot, 4.0}, "driven, with the time");
  }
  void add_mover_rows() {
    if (!scene.movers.empty())
      add_trail(10.0, scene.moment ? "movers at " + moment_time(scene) : "movers at the end");
    else if (std::ranges::any_of(scene.tracks, went_somewhere))
      add_trail(5.0, "tracked as moving");
    if (std::ranges::any_of(scene.movers, &Trail::flagged))
      add_disc(10.0, colour_of(0), {ink::kForced, 3.0}, "was forced to turn");
  }
  void add_moment_rows() {
    if (!scene.moment) return;
    if (!scene.moment->field.psi.empty()) {
      const bool is_potential = scene.moment->field.of == FieldView::Of::kPotential;  // others end beyond the robot
      add_blank(is_potential ? "no room for the robot then" : "no room then, or too far off");
    }
    if (!scene.moment->band.empty()) add_line({ink::kBand, 3.2, 10.0}, "plan at " + moment_time(scene));
    if (!scene.moment->predictions.empty())
      add_disc(13.0, ink::kBand.faded(0.12), {ink::kBand, 1.6, 6.0}, "expected there by then");
  }
  void add_decision_rows() {
    if (!scene.decision) return;
    add_line({ink::kBand, 3.6}, "chosen, 6 s");
    for (std::size_t k = 0; k < std::min(scene.decision->ways.size(), kWayColours.size()); ++k) {
      const std::string dearer = formatted("%+.1f s: ", static_cast<double>(scene.decision->ways[k].dearer_s));
      add_line({kWayColours[k], 2.4}, dearer + scene.decision->ways[k].name);
    }
    if (scene.decision->futures.empty()) return;
    canvas.fill_disc(middle(), 5.0, kFutureColour.faded(0.5));
    end_row("where bodies may be");
  }
};

double draw_facts(Canvas& canvas, const PictureScene& scene, Vec2 at, double width) {
  for (const auto& [name, value] : scene.facts) {
    canvas.write(at, name, {kFactSize, ink::kFaint});
    canvas.write(at + Vec2{width, 0.0}, value, {kFactSize, ink::kText, Align::kRight, true});
    at.y += kFactLine;
  }
  return at.y;
}

/// The field's colours from goal to far away.
double draw_field_key(Canvas& canvas, Vec2 at, double width, const char* name) {
  constexpr std::int32_t kColumns = 64, kRows = 4;
  FieldRaster key{{0.0, 0.0}, kColumns, kRows, 1.0, {}};
  for (std::int32_t i = 0; i < kRows * kColumns; ++i) key.psi.push_back(static_cast<float>(i % kColumns));
  draw_field(canvas, MapFrame({{0.0, 0.0}, {kColumns, kRows}}, at, {width, width}), key);
  canvas.write(at + Vec2{0.0, 40.0}, "goal", {16.0, ink::kFaint});
  canvas.write(at + Vec2{width / 2.0, 40.0}, name, {16.0, ink::kFaint, Align::kCentre});
  canvas.write(at + Vec2{width, 40.0}, "far", {16.0, ink::kFaint, Align::kRight});
  return at.y + 70.0;
}

/// Why a plan may cross walls that the picture shows.
void draw_note(Canvas& canvas, Vec2 at) {
  const Lettering small{16.0, ink::kFaint};
  canvas.write(at, "Plan and field rest on what had been", small);
  canvas.write(at + Vec2{0.0, 22.0}, "seen by then; the walls came to be", small);
  canvas.write(at + Vec2{0.0, 44.0}, "known in the whole run.", small);
}

void draw_axes(Canvas& canvas, const MapFrame& to_sheet) {
  const Extent& e = to_sheet.extent();
  const double step = round_length(std::max(to_sheet.width_m(), to_sheet.height_m()) / 14.0);
  const Vec2 corner = to_sheet.upper_left();
  const Vec2 size = to_sheet.size();
  const Lettering numbers{18.0, ink::kFaint, Align::kCentre};
  for (double x = std::ceil(e.low.x / step) * step; x <= e.high.x; x += step) {
    const Vec2 at = to_sheet({x, e.low.y});
    canvas.stroke({at, at + Vec2{0.0, 7.0}}, {ink::kFaint, 1.5});
    canvas.write(at + Vec2{0.0, 27.0}, metres(x), numbers);
  }
  for (double y = std::ceil(e.low.y / step) * step; y <= e.high.y; y += step) {
    const Vec2 at = to_sheet({e.low.x, y});
    canvas.stroke({at, at - Vec2{7.0, 0.0}}, {ink::kFaint, 1.5});
    canvas.write(at + Vec2{-12.0, 6.0}, metres(y), {18.0, ink::kFaint, Align::kRight});
  }
  canvas.stroke({corner, corner + Vec2{size.x, 0.0}, corner + size, corner + Vec2{0.0, size.y}}, {ink::kFaint, 1.5},
                true);
  canvas.write(corner + Vec2{size.x / 2.0, size.y + 54.0}, "x (m)", numbers);
  canvas.write(corner + Vec2{-12.0, -12.0}, "y (m)", {18.0, ink::kFaint, Align::kRight});
}

void draw_scale_bar(Canvas& canvas, const MapFrame& to_sheet) {
  const double length_m = round_length(to_sheet.width_m() / 14.0);
  const Vec2 right = to_sheet.upper_left() + to_sheet.size() + Vec2{0.0, 44.0};
  const Vec2 left = right - Vec2{to_sheet.pixels(length_m), 0.0};
  canvas.stroke({left, right}, {ink::kText, 4.0});
  canvas.stroke({left - Vec2{0.0, 6.0}, left + Vec2{0.0, 6.0}}, {ink::kText, 2.0});
  canvas.stroke({right - Vec2{0.0, 6.0}, right + Vec2{0.0, 6.0}}, {ink::kText, 2.0});
  canvas.write(left + Vec2{-12.0, 6.0}, metres(length_m) + " m", {18.0, ink::kText, Align::kRight});
}

/// Draws the facts and the legend in a column from its upper left corner, in units of the canvas.
void draw_panel(Canvas& canvas, const PictureScene& scene, Vec2 upper_left, double width) {
  Vec2 at = upper_left + Vec2{0.0, kFactSize};
  at.y = draw_facts(canvas, scene, at, width);
  at.y += 10.0;
  if (scene.moment && !scene.moment->field.psi.empty()) {
    const bool is_potential = scene.moment->field.of == FieldView::Of::kPotential;
    at.y = draw_field_key(canvas, at, width, is_potential ? "potential" : "time to go");
  }
  Legend legend{canvas, scene, at};
  legend.add_map_rows();
  legend.add_mover_rows();
  legend.add_moment_rows();
  legend.add_decision_rows();
  if (scene.moment) draw_note(canvas, legend.at + Vec2{0.0, 4.0});
}

// The sheet: a margin for the axes on the left, the title above, the panel on the right.
constexpr Vec2 kMapCorner{92.0, 104.0}, kMapMost{1400.0, 1300.0};
constexpr double kPanelGap = 44.0, kPanelWidth = 330.0, kRightMargin = 36.0, kFoot = 76.0, kLeastHeight = 640.0;

/// The extent with as much added on two sides as it takes to be neither a tower nor a ribbon.
Extent filled_out(const Extent& extent) {
  constexpr double kLeastWide = 0.95, kLeastHigh = 0.4;
  const Vec2 size = extent.high - extent.low;
  const Vec2 more =
      Vec2{std::max(kLeastWide * size.y - size.x, 0.0), std::max(kLeastHigh * size.x - size.y, 0.0)} * 0.5;
  return {extent.low - more, extent.high + more};
}

/// When movers are shown: at the moment of the plan, without one at the end.
Time shown_time(const PictureScene& scene) {
  if (scene.moment) return scene.moment->t;
  Time end = scene.driven.empty() ? kNever : scene.driven.back().t;
  for (const Trail& trail : scene.movers)
    if (!trail.points.empty()) end = std::max(end, trail.points.back().t);
  return end;
}

/// Where the field is of interest: inside the walls where these are known, else all that is shown.
Extent field_extent(const PictureScene& scene, const Extent& shown) {
  if (scene.walls.empty()) return shown;
  Extent inside;
  for (const sim::WallSegment& wall : scene.walls) inside.hold(wall.from), inside.hold(wall.to);
  return inside;
}

void draw_map(Canvas& canvas, const MapFrame& to_sheet, const PictureScene& scene) {
  canvas.clip(to_sheet.upper_left(), to_sheet.size());
  if (scene.moment) {
    draw_field(canvas, to_sheet, cropped(scene.moment->field, field_extent(scene, to_sheet.extent())));
  }
  draw_zones(canvas, to_sheet, scene);
  draw_walls(canvas, to_sheet, scene);
  draw_movers(canvas, to_sheet, scene.movers, shown_time(scene));
  if (scene.movers.empty()) draw_tracks(canvas, to_sheet, scene.tracks);
  draw_drive(canvas, to_sheet, scene);
  draw_moment(canvas, to_sheet, scene);
  if (scene.decision) draw_decision(canvas, to_sheet, *scene.decision);
  draw_ends(canvas, to_sheet, scene);
  canvas.unclip();
}

}  // namespace

bool can_draw_pictures() { return load_cairo() != nullptr; }

void draw_picture(const PictureScene& scene, const std::string& file) {
  const MapFrame to_sheet(filled_out(scene.extent), kMapCorner, kMapMost);
  const Vec2 map = to_sheet.size();
  const double panel = kMapCorner.x + map.x + kPanelGap;
  const double height = std::max(kMapCorner.y + map.y + kFoot, kLeastHeight);
  Canvas canvas(static_cast<int>(panel + kPanelWidth + kRightMargin), static_cast<int>(height));
  canvas.write({kMapCorner.x, 56.0}, scene.title, {34.0, ink::kText, Align::kLeft, true});
  draw_map(canvas, to_sheet, scene);
  draw_axes(canvas, to_sheet);
  draw_scale_bar(canvas, to_sheet);
  draw_panel(canvas, scene, {panel, kMapCorner.y}, kPanelWidth);
  canvas.save_png(file);
}

}  // namespace jaywalk
