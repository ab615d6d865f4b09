#pragma once
// Cell functions take values and return a value. The same source gives the same bits on the processor and on the
// graphics card: of + - x / sqrt, comparisons, integers and polynomials alone.
#ifdef __CUDACC__
#define JAYWALK_CELL __host__ __device__ inline
#define JAYWALK_ANYWHERE __host__ __device__ inline
#else
#define JAYWALK_ANYWHERE inline                     // for functions too long to be put into each of their callers
#define JAYWALK_CELL [[gnu::always_inline]] inline  // a stage that is called cannot go four cells at a time
#endif
#include <cstdint>
#include <cstring>
#include <limits>

namespace jaywalk::cell {

/// psi of a free cell from which the goal cannot be reached.
inline constexpr float kUnreachable = std::numeric_limits<float>::infinity();
/// psi of a cell that is not free.
inline constexpr float kNotFree = std::numeric_limits<float>::quiet_NaN();

inline constexpr float kLargest = std::numeric_limits<float>::max();

/// Whether a cell with this psi is free and joined to the goal (false for NaN and infinity).
JAYWALK_CELL bool is_joined(float psi) { return psi <= kLargest; }

// Exact Euclidean distance transform in integers, separable as Meijster, Roerdink and Hesselink
// (2000) have it: along a row, cell u sees the nearest obstacle of column i at squared distance
// (u - i)^2 + g_i^2, where g_i is that column's distance to its own nearest obstacle.

/// Squared distance from column `u` to the nearest obstacle of column `i`, `g` rows away.
JAYWALK_CELL std::int32_t squared_distance(std::int32_t u, std::int32_t i, std::int32_t g) {
  return (u - i) * (u - i) + g * g;
}

/// Last column at which column `i` is still no farther than column `u` > i.
JAYWALK_CELL std::int32_t last_nearer(std::int32_t i, std::int32_t gi, std::int32_t u, std::int32_t gu) {
  return (u * u - i * i + gu * gu - gi * gi) / (2 * (u - i));
}

/// The lower envelope along columns `first` to `last` of a row: fills `column` with those that have the nearest
/// obstacle to some cell, `begin` with the first cell of each one's stretch, and returns how many. `rows_away(i)`: of
/// column i, negative: it has no obstacle and is passed over.
template <class RowsAway>
JAYWALK_CELL std::int32_t lower_envelope(std::int32_t first, std::int32_t last, const RowsAway& rows_away,
                                         std::int32_t* column, std::int32_t* begin) {
  std::int32_t count = 0;
  for (std::int32_t u = first; u <= last; ++u) {
    const std::int32_t g = rows_away(u);
    if (g < 0) continue;
    while (count > 0 && squared_distance(begin[count - 1], column[count - 1], rows_away(column[count - 1])) >
                            squared_distance(begin[count - 1], u, g)) {
      --count;
    }
    const std::int32_t from =
        count == 0 ? first : 1 + last_nearer(column[count - 1], rows_away(column[count - 1]), u, g);
    if (from > last) continue;
    column[count] = u;
    begin[count++] = from;
  }
  return count;
}

// Elementary functions from IEEE operations alone.

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

inline constexpr float kPiF = 3.14159265F;

/// A direction as a unit vector.
struct Heading {
  float x = 1.0F, y = 0.0F;
};

/// The direction at `rad` radians from +x; error below 8e-6 for |rad| up to 100.
JAYWALK_CELL Heading heading_at(float rad) {
  // rad = q pi/2 + r with |r| <= pi/4; pi/2 in two parts, the first exact in 12 bits. r^9/9! < 4e-7, r^8/8! < 4e-6.
  const float quarters = rad * 0.636619772F;
  const auto q = static_cast<std::int32_t>(quarters < 0.0F ? quarters - 0.5F : quarters + 0.5F);
  const auto qf = static_cast<float>(q);
  const float r = (rad - qf * 1.57080078F) + qf * 4.45445511e-6F;
  const float r2 = r * r;
  const float s = r * (1.0F + r2 * (-1.0F / 6.0F + r2 * (1.0F / 120.0F + r2 * (-1.0F / 5040.0F))));
  const float c = 1.0F + r2 * (-0.5F + r2 * (1.0F / 24.0F + r2 * (-1.0F / 720.0F + r2 * (1.0F / 40320.0F))));
  const bool swapped = (q & 1) != 0, negative_x = ((q + 1) & 2) != 0, negative_y = (q & 2) != 0;
  const float x = swapped ? s : c, y = swapped ? c : s;
  return {negative_x ? -x : x, negative_y ? -y : y};
}

/// The angle of (x, y) in [-pi, pi], 0 at the origin; error below 3e-5 rad.
JAYWALK_CELL float angle_of(float x, float y) {
  const float ax = x < 0.0F ? -x : x, ay = y < 0.0F ? -y : y;
  const float larger = ax > ay ? ax : ay, smaller = ax > ay ? ay : ax;
  if (larger <= 0.0F) return 0.0F;
  // atan on [0, 1]; coefficients: Abramowitz and Stegun, Handbook of Mathematical Functions, 4.4.49.
  const float z = smaller / larger, z2 = z * z;
  const float in_octant =
      z * (0.9998660F + z2 * (-0.3302995F + z2 * (0.1801410F + z2 * (-0.0851330F + z2 * 0.0208351F))));
  const float in_quadrant = ay > ax ? 0.5F * kPiF - in_octant : in_octant;
  const float in_half = x < 0.0F ? kPiF - in_quadrant : in_quadrant;
  return y < 0.0F ? -in_half : in_half;
}

/// The same angle in [-pi, pi]; |rad| up to 1000.
JAYWALK_CELL float wrapped(float rad) {
  const float turns = rad * 0.159154943F;
  const auto whole = static_cast<float>(static_cast<std::int32_t>(turns < 0.0F ? turns - 0.5F : turns + 0.5F));
  return rad - whole * 6.28318531F;
}

}  // namespace jaywalk::cell
