#pragma once
#include <string>

#include "apps/report/picture/scene.h"

namespace jaywalk {
/// Whether pictures can be drawn: cairo is loaded when first asked for. Not for the loop.
[[nodiscard]] bool can_draw_pictures();

/// Draws the scene and writes it as a PNG about 1,900 pixels wide: walls, field, movers, drive, plan;
/// beside the map its facts and a legend. The same scene gives the same bytes on the same machine
/// (letters come from the font "DejaVu Sans" by way of cairo). Throws StartupError when `file`
/// cannot be written, or cairo is not installed.
void draw_picture(const PictureScene& scene, const std::string& file);

}  // namespace jaywalk
