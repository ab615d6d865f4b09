#pragma once
// Layers of a picture that show the planner: its field, and a decision.
#include <array>
#include <vector>

#include "apps/report/picture/canvas.h"
#include "apps/report/picture/scene.h"

namespace jaywalk {
inline constexpr int kContours = 24;

/// Each cell's psi as the share of all finite cells that lie lower, in [0, 1): equal steps of it hold
/// equal areas, so that structure shows near the goal and far from it. NaN where psi is not finite.
[[nodiscard]] std::vector<float> ranks(const std::vector<float>& psi);

/// Ends of the straight pieces of the line where `level` runs between cell centres (marching squares);
/// piece k is points 2k and 2k + 1, in cells from the first cell's centre. None across a cell that
/// is NaN.
[[nodiscard]] Polyline contour(const std::vector<float>& values, std::int32_t width, std::int32_t height, float level);

/// The part of the field whose cells' centres lie within `extent`; no cells where none do.
[[nodiscard]] FieldRaster cropped(const FieldRaster& field, const Extent& extent);

/// A colour wash from the goal outwards, with contour lines.
void draw_field(Canvas& canvas, const MapFrame& to_sheet, const FieldRaster& field);

/// Of the ways that were not chosen, the cheapest first: as many are shown.
inline constexpr std::array<Colour, 5> kWayColours{colour(0x1B8A4B), colour(0xC9A227), colour(0x0F8B8D),
                                                   colour(0xC2182B), colour(0x6B4E2E)};
inline constexpr Colour kFutureColour = colour(0x7A3E9D);

/// Futures as clouds, later ones fainter; other ways dashed; the one that was chosen on top.
void draw_decision(Canvas& canvas, const MapFrame& to_sheet, const DecisionScene& decision);

}  // namespace jaywalk
