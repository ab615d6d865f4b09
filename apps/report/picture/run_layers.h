#pragma once
// What lies on the map, one function a layer, drawn from the bottom up.
#include <array>
#include <vector>

#include "apps/report/picture/canvas.h"
#include "apps/report/picture/scene.h"

namespace jaywalk {

namespace ink {
inline constexpr Colour kText = colour(0x2B2F36);
inline constexpr Colour kFaint = colour(0x8A919C);
inline constexpr Colour kWall = colour(0xB9BEC6);
inline constexpr Colour kSeen = colour(0x3A3F47);
inline constexpr Colour kRobot = colour(0x17406D);
inline constexpr Colour kGoal = colour(0x1B8A4B);
inline constexpr Colour kBand = colour(0xE0641E);
inline constexpr Colour kKeepOut = colour(0xB3261E);
inline constexpr Colour kSlow = colour(0xC79A00);
inline constexpr Colour kForced = colour(0xC2182B);
}  // namespace ink

[[nodiscard]] Colour colour_of(std::uint32_t id);

[[nodiscard]] inline Polyline on_sheet(const std::vector<Vec2>& line, const MapFrame& to_sheet) {
  Polyline points;
  for (const Vec2 p : line) points.push_back(to_sheet(p));
  return points;
}

/// How thick lines are: 1 where the map is shown at 50 pixels a metre, more or less with its size.
[[nodiscard]] double weight_of(const MapFrame& to_sheet);

[[nodiscard]] Colour colour_of(ZoneKind kind);
void draw_zones(Canvas& canvas, const MapFrame& to_sheet, const PictureScene& scene);
void draw_walls(Canvas& canvas, const MapFrame& to_sheet, const PictureScene& scene);
/// Trails up to time `t`, older parts fainter; a disc shows the body at `t`, ringed where it was forced at some time.
void draw_movers(Canvas& canvas, const MapFrame& to_sheet, const std::vector<Trail>& movers, Time t);
/// What the controller took for moving and saw go further than a step.
void draw_tracks(Canvas& canvas, const MapFrame& to_sheet, const std::vector<Trail>& tracks);
/// Whether draw_tracks shows it.
[[nodiscard]] bool went_somewhere(const Trail& track);
/// The robot's way with its outline now and then, and the time every ten seconds or so.
void draw_drive(Canvas& canvas, const MapFrame& to_sheet, const PictureScene& scene);
/// The part of the straight way from `from` to `to` that a disc of `radius_m` (m) can go before it meets a wall (where
/// no walls are known: a cell that was seen occupied), as its end; `from` itself where it touches one already.
[[nodiscard]] Vec2 end_before_wall(const PictureScene& scene, Vec2 from, Vec2 to, double radius_m);
void draw_moment(Canvas& canvas, const MapFrame& to_sheet, const PictureScene& scene);
void draw_ends(Canvas& canvas, const MapFrame& to_sheet, const PictureScene& scene);

/// Each cell's psi as the share of all finite cells that lie lower, in [0, 1): equal steps of it hold
/// equal areas, so that structure shows near the goal and far from it. NaN where psi is not finite.
[[nodiscard]] std::vector<float> ranks(const std::vector<float>& psi);

/// Ends of the straight pieces of the line where `level` runs between cell centres (marching squares);
/// piece k is points 2k and 2k + 1, in cells from the first cell's centre. None across a cell that
/// is NaN.
[[nodiscard]] Polyline contour(const std::vector<float>& values, std::int32_t width, std::int32_t height, float level);

/// The cells of `field` with centres within `extent`; empty if there are none.
[[nodiscard]] FieldRaster cropped(const FieldRaster& field, const Extent& extent);

/// A colour wash from the goal outwards, with contour lines.
void draw_field(Canvas& canvas, const MapFrame& to_sheet, const FieldRaster& field);

/// Colours of the alternatives that were not chosen, cheapest first; the picture shows only so many.
inline constexpr std::array<Colour, 5> kWayColours{colour(0x1B8A4B), colour(0xC9A227), colour(0x0F8B8D),
                                                   colour(0xC2182B), colour(0x6B4E2E)};
inline constexpr Colour kFutureColour = colour(0x7A3E9D);

/// Futures as clouds, later ones fainter; other ways dashed; the one that was chosen on top.
void draw_decision(Canvas& canvas, const MapFrame& to_sheet, const DecisionScene& decision);

}  // namespace jaywalk
