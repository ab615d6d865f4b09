#pragma once
// What stands round the map: title, axes in metres, scale bar, facts, legend.
#include "apps/report/picture/canvas.h"
#include "apps/report/picture/scene.h"

namespace jaywalk {
void draw_axes(Canvas& canvas, const MapFrame& to_sheet);
void draw_scale_bar(Canvas& canvas, const MapFrame& to_sheet);
/// Facts and legend in a column whose upper left corner is given.
void draw_panel(Canvas& canvas, const PictureScene& scene, Vec2 upper_left, double width);

}  // namespace jaywalk
