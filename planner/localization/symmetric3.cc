#include "planner/localization/symmetric3.h"

namespace jaywalk {

Row3 Symmetric3::operator*(const Row3& v) const {
  return {xx * v.x + xy * v.y + xh * v.heading, xy * v.x + yy * v.y + yh * v.heading,
          xh * v.x + yh * v.y + hh * v.heading};
}

Symmetric3 Symmetric3::operator+(const Symmetric3& o) const {
  return {xx + o.xx, xy + o.xy, xh + o.xh, yy + o.yy, yh + o.yh, hh + o.hh};
}

void Symmetric3::add_outer(const Row3& r, double w) {
  xx += w * r.x * r.x;
  xy += w * r.x * r.y;
  xh += w * r.x * r.heading;
  yy += w * r.y * r.y;
  yh += w * r.y * r.heading;
  hh += w * r.heading * r.heading;
}

double Symmetric3::quadratic(const Row3& r) const {
  const Row3 p = *this * r;
  return r.x * p.x + r.y * p.y + r.heading * p.heading;
}

Symmetric3 diagonal(double xx, double yy, double hh) { return {xx, 0.0, 0.0, yy, 0.0, hh}; }

Symmetric3 inverse(const Symmetric3& m) {
  const double a = m.yy * m.hh - m.yh * m.yh;
  const double b = m.xh * m.yh - m.xy * m.hh;
  const double c = m.xy * m.yh - m.xh * m.yy;
  const double scale = 1.0 / (m.xx * a + m.xy * b + m.xh * c);
  return {a * scale,
          b * scale,
          c * scale,
          (m.xx * m.hh - m.xh * m.xh) * scale,
          (m.xy * m.xh - m.xx * m.yh) * scale,
          (m.xx * m.yy - m.xy * m.xy) * scale};
}

}  // namespace jaywalk
