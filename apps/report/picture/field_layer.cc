#include <algorithm>
#include <cmath>
#include <limits>

#include "apps/report/picture/run_layers.h"

namespace jaywalk {
namespace {
/// From the goal outwards: light and warm to darker and cool, calm enough to draw upon.
constexpr std::array<Colour, 4> kRamp{colour(0xFFFBE8), colour(0xE4F0DC), colour(0xC3DCE6), colour(0xA9B6D8)};
constexpr Colour kContourColour = colour(0x5C7A99);
constexpr int kContours = 24;

Colour ramp(float rank) {
  if (std::isnan(rank)) return {1.0, 1.0, 1.0, 0.0};
  const double place = static_cast<double>(rank) * (kRamp.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(place), kRamp.size() - 2);
  const double part = place - static_cast<double>(below);
  const auto mix = [&](double a, double b) { return a + (b - a) * part; };
  const Colour& a = kRamp[below];
  const Colour& b = kRamp[below + 1];
  return {mix(a.red, b.red), mix(a.green, b.green), mix(a.blue, b.blue), 1.0};
}

/// A square between four cell centres: its corners and their values, counter-clockwise from the lower left.
struct Square {
  std::array<Vec2, 4> corner;
  std::array<float, 4> value;
};

/// Appends the pieces of one square: where the level crosses its sides, taken in pairs.
void add_pieces(Polyline& pieces, const Square& square, float level) {
  if (std::ranges::any_of(square.value, [](float v) { return std::isnan(v); })) return;
  for (std::size_t k = 0; k < 4; ++k) {
    const std::size_t next = (k + 1) % 4;
    const float here = square.value[k], there = square.value[next];
    if ((here < level) == (there < level)) continue;
    const double part = static_cast<double>((level - here) / (there - here));
    pieces.push_back(square.corner[k] + (square.corner[next] - square.corner[k]) * part);
  }
}

void draw_wash(Canvas& canvas, const MapFrame& to_sheet, const FieldRaster& field, const std::vector<float>& rank) {
  std::vector<Colour> pixels;
  pixels.reserve(rank.size());
  const auto width = static_cast<std::size_t>(field.width);
  for (std::size_t row = static_cast<std::size_t>(field.height); row-- > 0;) {
    for (std::size_t column = 0; column < width; ++column) pixels.push_back(ramp(rank[row * width + column]));
  }
  const double width_m = field.width * field.cell_m;
  const double height_m = field.height * field.cell_m;
  canvas.image(pixels, field.width, field.height, to_sheet(field.low + Vec2{0.0, height_m}),
               {to_sheet.pixels(width_m), to_sheet.pixels(height_m)});
}

}  // namespace

FieldRaster cropped(const FieldRaster& field, const Extent& extent) {
  const Vec2 low = (extent.low - field.low) * (1.0 / field.cell_m);
  const Vec2 high = (extent.high - field.low) * (1.0 / field.cell_m);
  const auto cell = [](double edge, std::int32_t most) {
    return static_cast<std::int32_t>(std::clamp(std::floor(edge + 0.5), 0.0, static_cast<double>(most)));
  };
  const std::int32_t left = cell(low.x, field.width), right = std::max(left, cell(high.x, field.width));
  const std::int32_t bottom = cell(low.y, field.height), top = std::max(bottom, cell(high.y, field.height));
  FieldRaster part{
      field.low + Vec2{left * field.cell_m, bottom * field.cell_m}, right - left, top - bottom, field.cell_m, {}};
  for (std::int32_t j = bottom; j < top; ++j) {
    const auto row = field.psi.begin() + static_cast<std::ptrdiff_t>(j) * field.width;
    part.psi.insert(part.psi.end(), row + left, row + right);
  }
  return part;
}

std::vector<float> ranks(const std::vector<float>& psi) {
  std::vector<float> sorted;
  std::copy_if(psi.begin(), psi.end(), std::back_inserter(sorted), [](float v) { return std::isfinite(v); });
  std::sort(sorted.begin(), sorted.end());
  std::vector<float> rank(psi.size(), std::numeric_limits<float>::quiet_NaN());
  for (std::size_t i = 0; i < psi.size(); ++i) {
    if (!std::isfinite(psi[i])) continue;
    const auto lower = std::lower_bound(sorted.begin(), sorted.end(), psi[i]) - sorted.begin();
    rank[i] = static_cast<float>(static_cast<double>(lower) / static_cast<double>(sorted.size()));
  }
  return rank;
}

Polyline contour(const std::vector<float>& values, std::int32_t width, std::int32_t height, float level) {
  Polyline pieces;
  const auto at = [&](std::int32_t i, std::int32_t j) {
    return values[static_cast<std::size_t>(j) * static_cast<std::size_t>(width) + static_cast<std::size_t>(i)];
  };
  for (std::int32_t j = 0; j + 1 < height; ++j) {
    for (std::int32_t i = 0; i + 1 < width; ++i) {
      const double x = i, y = j;
      add_pieces(pieces,
                 {{{{x, y}, {x + 1.0, y}, {x + 1.0, y + 1.0}, {x, y + 1.0}}},
                  {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)}},
                 level);
    }
  }
  return pieces;
}

void draw_field(Canvas& canvas, const MapFrame& to_sheet, const FieldRaster& field) {
  if (field.psi.empty()) return;
  const std::vector<float> rank = ranks(field.psi);
  draw_wash(canvas, to_sheet, field, rank);
  const Vec2 first_centre = field.low + Vec2{field.cell_m / 2.0, field.cell_m / 2.0};
  for (int i = 1; i < kContours; ++i) {
    const float level = static_cast<float>(i) / static_cast<float>(kContours);
    const Polyline pieces = contour(rank, field.width, field.height, level);
    for (std::size_t k = 0; k + 1 < pieces.size(); k += 2) {
      canvas.stroke(
          {to_sheet(first_centre + pieces[k] * field.cell_m), to_sheet(first_centre + pieces[k + 1] * field.cell_m)},
          {kContourColour.faded(0.5), 1.0});
    }
  }
}

void draw_decision(Canvas& canvas, const MapFrame& to_sheet, const DecisionScene& decision) {
  const double weight = weight_of(to_sheet);
  for (const FuturePlace& place : decision.futures) {
    canvas.fill_disc(to_sheet(place.at), 2.2 * weight, kFutureColour.faded(0.5 * (1.0 - 0.8 * place.horizon_share)));
  }
  for (std::size_t k = std::min(decision.ways.size(), kWayColours.size()); k-- > 0;)
    canvas.stroke(on_sheet(decision.ways[k].places, to_sheet), {kWayColours[k], 2.0 * weight, 8.0 * weight});
  canvas.stroke(on_sheet(decision.chosen, to_sheet), {ink::kBand, 3.6 * weight});
}

}  // namespace jaywalk
