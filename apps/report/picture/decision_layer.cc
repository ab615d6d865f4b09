#include "apps/report/picture/decision_layer.h"

#include <algorithm>

#include "apps/report/picture/run_layers.h"

namespace jaywalk {
namespace {

Polyline on_sheet(const std::vector<Vec2>& way, const MapFrame& to_sheet) {
  Polyline line;
  for (const Vec2 p : way) line.push_back(to_sheet(p));
  return line;
}

Colour colour_of_cost(float above_cheapest_s) {
  return std::find_if(kCostColours.begin(), kCostColours.end() - 1,
                      [above_cheapest_s](const auto& c) { return above_cheapest_s <= c.first; })
      ->second;
}

}  // namespace

void draw_decision(Canvas& canvas, const MapFrame& to_sheet, const DecisionScene& decision) {
  const double weight = weight_of(to_sheet);
  for (const FuturePlace& place : decision.futures) {
    canvas.fill_disc(to_sheet(place.at), 2.2 * weight, kFutureColour.faded(0.5 * (1.0 - 0.8 * place.horizon_share)));
  }
  for (auto way = decision.ways.rbegin(); way != decision.ways.rend(); ++way) {
    const float above = way->cost_s - decision.ways.front().cost_s;
    canvas.stroke(on_sheet(way->places, to_sheet), {colour_of_cost(above).faded(0.45), 1.2 * weight});
  }
  canvas.stroke(on_sheet(decision.chosen, to_sheet), {ink::kBand, 3.6 * weight});
}

}  // namespace jaywalk
