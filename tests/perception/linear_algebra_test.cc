// Eigen as the float contract needs it (docs/explanation/conventions.md).
#include <Eigen/Dense>

#include "tests/support/catch.h"

using Eigen::Matrix3d;
using Eigen::Vector3d;

TEST_CASE("matrix products round every product") {
  // (1 + 2^-27)^2 is 1 + 2^-26 + 2^-54, and 1 + 2^-26 rounded: a fused instruction would leave 2^-54.
  volatile double one = 1.0;  // so that no compiler works it out
  const double a = one + 0x1p-27;
  Matrix3d m = Matrix3d::Identity();
  m.row(0) << -(one + 0x1p-26), a, 0.0;
  const Vector3d v(1.0, a, 0.0);
  CHECK((m * v)(0) == 0.0);
}

TEST_CASE("a new matrix is zero") { CHECK(Matrix3d().cwiseAbs().sum() == 0.0); }
