#include "hal/types/trig.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace jaywalk {
namespace {

// pi/2 in two parts (Cody and Waite): the first has 33 significant bits, so that quadrant * kHalfPiHigh is exact for
// |quadrant| below 2^20, that is for angles up to 1.6e6 rad.
constexpr double kHalfPiHigh = 0x1.921fb544p+0;
constexpr double kHalfPiLow = 0x1.0b4611a626331p-34;

// Taylor series about 0, good below 1e-16 for |r| <= pi/4: the first term left out is r^19/19! < 1e-19 and r^18/18!.
double sin_near_zero(double r) {
  const double r2 = r * r;
  double sum = 0.0;
  for (int n = 17; n >= 3; n -= 2) sum = (1.0 + sum) * -r2 / (n * (n - 1));
  return r + r * sum;
}

double cos_near_zero(double r) {
  const double r2 = r * r;
  double sum = 0.0;
  for (int n = 18; n >= 2; n -= 2) sum = (1.0 + sum) * -r2 / (n * (n - 1));
  return 1.0 + sum;
}

/// sin of (rad + quarter_turns * pi/2).
double sin_shifted(double rad, int quarter_turns) {
  const double quadrant = std::floor(rad / kHalfPiHigh + 0.5);
  const double r = (rad - quadrant * kHalfPiHigh) - quadrant * kHalfPiLow;
  const auto turn = (static_cast<std::int64_t>(quadrant) + quarter_turns) & 3;
  const double magnitude = (turn & 1) ? cos_near_zero(r) : sin_near_zero(r);
  return (turn & 2) ? -magnitude : magnitude;
}

/// atan for z in [0, 1]: reduced by atan(z) = atan(c) + atan((z - c)/(1 + z c)) to |z| <= 1/8, then its series.
double atan_unit(double z) {
  struct Anchor {
    double tangent, angle;
  };
  constexpr Anchor kAnchors[] = {{0.0, 0.0},
                                 {0.25, 0.24497866312686415},
                                 {0.5, 0.46364760900080612},
                                 {0.75, 0.64350110879328439},
                                 {1.0, 0.78539816339744831}};
  const Anchor& a = kAnchors[static_cast<int>(std::floor(z * 4.0 + 0.5))];
  const double t = (z - a.tangent) / (1.0 + z * a.tangent);
  const double t2 = t * t;
  double sum = 0.0;
  for (int n = 17; n >= 3; n -= 2) sum = (1.0 / n - sum) * t2;
  return a.angle + (t - t * sum);
}

}  // namespace

double sin(double rad) noexcept { return sin_shifted(rad, 0); }
double cos(double rad) noexcept { return sin_shifted(rad, 1); }

double atan2(double y, double x) noexcept {
  const double ax = std::fabs(x), ay = std::fabs(y);
  if (ax == 0.0 && ay == 0.0) return 0.0;
  double angle = ay <= ax ? atan_unit(ay / ax) : kPi / 2 - atan_unit(ax / ay);
  if (x < 0.0) angle = kPi - angle;
  return y < 0.0 ? -angle : angle;
}

double exp(double x) noexcept {
  // e^x = 2^k e^r with |r| <= ln2/2; the series to r^13/13! leaves 4e-18.
  constexpr double kLn2High = 0x1.62e42feep-1, kLn2Low = 0x1.a39ef35793c76p-33;
  const double clamped = x < -700.0 ? -700.0 : (x > 700.0 ? 700.0 : x);
  const double k = std::floor(clamped / (kLn2High + kLn2Low) + 0.5);
  const double r = (clamped - k * kLn2High) - k * kLn2Low;
  double sum = 1.0;
  for (int n = 13; n >= 1; --n) sum = 1.0 + r * sum / n;
  return sum * std::bit_cast<double>(static_cast<std::uint64_t>(static_cast<std::int64_t>(k) + 1023) << 52);
}

double log(double x) noexcept {
  if (!(x > 0.0)) return x == 0.0 ? -std::numeric_limits<double>::infinity() : std::numeric_limits<double>::quiet_NaN();
  // x = 2^k m with m in [sqrt(1/2), sqrt(2)); ln m = 2 artanh((m-1)/(m+1)), |s| <= 0.172, s^21/21 < 5e-18.
  const auto bits = std::bit_cast<std::uint64_t>(x);
  auto k = static_cast<std::int64_t>(bits >> 52) - 1023;
  double m = std::bit_cast<double>((bits & 0x000fffffffffffffULL) | 0x3ff0000000000000ULL);
  if (m > 1.4142135623730951) m *= 0.5, ++k;
  const double s = (m - 1.0) / (m + 1.0);
  const double s2 = s * s;
  double sum = 0.0;
  for (int n = 19; n >= 3; n -= 2) sum = (sum + 1.0 / n) * s2;
  return static_cast<double>(k) * 0.69314718055994531 + 2.0 * (s + s * sum);
}

double wrap_angle(double rad) noexcept {
  const double turns = std::floor((rad + kPi) / (2 * kPi));
  const double wrapped = rad - turns * (2 * kPi);
  return wrapped <= -kPi ? kPi : wrapped;
}

}  // namespace jaywalk
