#pragma once
#include "hal/types/geometry.h"

namespace jaywalk {

/// A row (x, y, heading).
struct Row3 {
  double x = 0.0, y = 0.0, heading = 0.0;
};

/// A symmetric 3 x 3 matrix over (x, y, heading): a covariance (m^2, m rad, rad^2) or its inverse.
struct Symmetric3 {
  double xx = 0.0, xy = 0.0, xh = 0.0, yy = 0.0, yh = 0.0, hh = 0.0;

  [[nodiscard]] Row3 operator*(const Row3& v) const;
  [[nodiscard]] Symmetric3 operator+(const Symmetric3& o) const;
  /// Adds weight * row * row^T.
  void add_outer(const Row3& row, double weight);
  /// row^T M row.
  [[nodiscard]] double quadratic(const Row3& row) const;
};

[[nodiscard]] Symmetric3 diagonal(double xx, double yy, double hh);
/// The inverse, by cofactors; `m` is positive definite.
[[nodiscard]] Symmetric3 inverse(const Symmetric3& m);

}  // namespace jaywalk
