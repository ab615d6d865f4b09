#pragma once
// exp and log in single precision from IEEE operations alone: the same bits on every processor.
#include <cstdint>
#include <cstring>

#include "planner/cell/cell.h"

namespace jaywalk::cell {

JAYWALK_CELL float float_of_bits(std::int32_t bits) {
  float value;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

JAYWALK_CELL std::int32_t bits_of_float(float value) {
  std::int32_t bits;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

/// The next number above x >= 0 that single precision has.
JAYWALK_CELL float next_above(float x) { return float_of_bits(bits_of_float(x) + 1); }

/// e^x, relative error below 3e-7 for x in [-80, 80]; clamped to that range outside it. x is not NaN.
JAYWALK_CELL float exp(float x) {
  const float in_range = x < -80.0F ? -80.0F : (x > 80.0F ? 80.0F : x);
  const float turns = in_range * 1.44269504F;
  const auto k = static_cast<std::int32_t>(turns < 0.0F ? turns - 0.5F : turns + 0.5F);
  const auto kf = static_cast<float>(k);
  // e^x = 2^k e^r with |r| <= ln2/2; ln2 in two parts, the first exact in 16 bits. r^7/7! < 2e-7 * e^r.
  const float r = (in_range - kf * 0.693145752F) - kf * 1.42860677e-6F;
  float sum = 1.0F / 720.0F;
  sum = sum * r + 1.0F / 120.0F;
  sum = sum * r + 1.0F / 24.0F;
  sum = sum * r + 1.0F / 6.0F;
  sum = sum * r + 0.5F;
  sum = sum * r + 1.0F;
  sum = sum * r + 1.0F;
  return sum * float_of_bits((k + 127) << 23);
}

/// ln x for normal x > 0; error below 3e-7 of max(|ln x|, |x - 1|).
JAYWALK_CELL float log(float x) {
  // x = 2^k m with m in [sqrt(1/2), sqrt(2)); ln m = 2 artanh(s), s = (m-1)/(m+1), |s| <= 0.172.
  const std::int32_t bits = bits_of_float(x);
  constexpr std::int32_t kSqrtHalf = 0x3f3504f3;
  const std::int32_t k = (bits - kSqrtHalf) >> 23;
  const float m = float_of_bits(bits - k * (1 << 23));
  const float s = (m - 1.0F) / (m + 1.0F);
  const float s2 = s * s;
  const float series = s2 * (1.0F / 3.0F + s2 * (1.0F / 5.0F + s2 * (1.0F / 7.0F + s2 * (1.0F / 9.0F))));
  return static_cast<float>(k) * 0.693147181F + 2.0F * (s + s * series);
}

}  // namespace jaywalk::cell
