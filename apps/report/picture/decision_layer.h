#pragma once
// How motion was decided: the ways that were weighed, by what they cost, and where movers were drawn to be.
#include <array>

#include "apps/report/picture/canvas.h"
#include "apps/report/picture/map_frame.h"
#include "apps/report/picture/scene.h"

namespace jaywalk {

/// Of the ways that were not chosen, the cheapest first: as many are shown.
inline constexpr std::array<Colour, 5> kWayColours{colour(0x1B8A4B), colour(0xC9A227), colour(0x0F8B8D),
                                                   colour(0xC2182B), colour(0x6B4E2E)};
inline constexpr Colour kFutureColour = colour(0x7A3E9D);

/// Futures as clouds, later ones fainter; other ways dashed; the one that was chosen on top.
void draw_decision(Canvas& canvas, const MapFrame& to_sheet, const DecisionScene& decision);

}  // namespace jaywalk
