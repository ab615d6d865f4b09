#include "apps/report/picture/picture.h"

#include <algorithm>

#include "apps/report/picture/cairo_library.h"
#include "apps/report/picture/canvas.h"
#include "apps/report/picture/field_layer.h"
#include "apps/report/picture/run_layers.h"
#include "apps/report/picture/sheet.h"

namespace jaywalk {
namespace {
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
  Time end = kNever;
  for (const DrivenPose& d : scene.driven) end = std::max(end, d.t);
  for (const Trail& trail : scene.movers) {
    for (const TrailPoint& p : trail.points) end = std::max(end, p.t);
  }
  return end;
}

/// Where the field is of interest: inside the walls where these are known, else all that is shown.
Extent field_extent(const PictureScene& scene, const Extent& shown) {
  if (scene.walls.empty()) return shown;
  Extent inside{scene.walls.front().from, scene.walls.front().from};
  for (const sim::WallSegment& wall : scene.walls) {
    for (const Vec2 p : {wall.from, wall.to}) {
      inside.low = {std::min(inside.low.x, p.x), std::min(inside.low.y, p.y)};
      inside.high = {std::max(inside.high.x, p.x), std::max(inside.high.y, p.y)};
    }
  }
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

bool can_draw_pictures() { return cairo_library() != nullptr; }

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
