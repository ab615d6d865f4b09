#pragma once
#include <vector>

#include "apps/report/picture/canvas.h"
#include "apps/report/picture/map_frame.h"

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

}  // namespace jaywalk
