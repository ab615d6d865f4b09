#include "apps/report/picture/decision_layer.h"

#include <algorithm>

#include "apps/report/picture/run_layers.h"

namespace jaywalk {

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
