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

/// An animated SVG has at most about this many bytes, however long the run.
inline constexpr std::size_t kMostSvgBytes = 100'000;

/// The scene as a moving picture for browsers and READMEs: SVG with SMIL animation and no script; it repeats for ever.
/// Walls, the robot with its way, goal, movers (tracks that moved where there are no movers). It plays in real time,
/// runs longer than a minute faster. Positions are 0.4 s apart, farther where the file would become too large. The same
/// scene gives the same text. An empty scene gives an empty map.
[[nodiscard]] std::string svg_of(const PictureScene& scene);

/// Writes svg_of(scene). Throws StartupError when `file` cannot be written.
void draw_svg(const PictureScene& scene, const std::string& file);

}  // namespace jaywalk
