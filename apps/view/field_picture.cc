#include "apps/view/field_picture.h"

#include <algorithm>
#include <cmath>

namespace jaywalk::view {
namespace {

constexpr std::uint8_t kNoWay = 254, kNotFree = 255;
constexpr std::uint8_t kNeverSeen = 127;  // added
constexpr double kFarthest = 126.0;

std::uint8_t byte_of(float psi, double most) noexcept {
  if (std::isnan(psi)) return kNotFree;
  if (std::isinf(psi)) return kNoWay;
  return static_cast<std::uint8_t>(std::clamp(kFarthest * static_cast<double>(psi) / most, 0.0, kFarthest));
}

}  // namespace

void draw(FieldPicture& into, const FieldView& field, const EvidenceMap& seen) noexcept {
  double most = 1e-6;
  for (const float psi : field.psi)
    if (std::isfinite(psi)) most = std::max(most, static_cast<double>(psi));
  std::int32_t step = 1;
  while (std::max(field.width, field.height) > step * kMostFieldSide) step *= 2;
  into.low_x_m = field.low.i * field.cell_m;
  into.low_y_m = field.low.j * field.cell_m;
  into.cell_m = field.cell_m * step;
  into.width = (field.width + step - 1) / step;
  into.cells.clear();
  for (std::int32_t y = 0; y < field.height; y += step) {
    const std::size_t row = static_cast<std::size_t>(y) * static_cast<std::size_t>(field.width);
    for (std::int32_t x = 0; x < field.width; x += step) {
      std::uint8_t byte = byte_of(field.psi[row + static_cast<std::size_t>(x)], most);
      if (byte < kNoWay && seen.evidence({field.low.i + x, field.low.j + y}) == 0) byte += kNeverSeen;
      static_cast<void>(into.cells.push_back(byte));
    }
  }
}

}  // namespace jaywalk::view
