#pragma once
// How motion was decided: the ways that were weighed, by what they cost, and where movers were drawn to be.
#include <array>
#include <utility>

#include "apps/report/picture/canvas.h"
#include "apps/report/picture/map_frame.h"
#include "apps/report/picture/scene.h"

namespace jaywalk {

/// Costs (s, above the cheapest) and the colours that ways of that cost are drawn in.
inline constexpr std::array<std::pair<float, Colour>, 3> kCostColours{
    {{0.5F, colour(0x1B8A4B)}, {3.0F, colour(0xC9A227)}, {1e9F, colour(0xC2182B)}}};
inline constexpr Colour kFutureColour = colour(0x7A3E9D);

/// Futures as clouds, later ones fainter; ways from the dearest to the cheapest; the one that was chosen on top.
void draw_decision(Canvas& canvas, const MapFrame& to_sheet, const DecisionScene& decision);

}  // namespace jaywalk
