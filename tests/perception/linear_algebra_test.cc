// Eigen as the float contract needs it (docs/explanation/conventions.md).
#include <Eigen/Dense>

#include "tests/support/allocation_guard.h"
#include "tests/support/catch.h"

using namespace jaywalk;
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

TEST_CASE("decompositions of fixed size do not allocate") {
  Matrix3d m;
  m << 4.0, 1.0, 0.5, 1.0, 3.0, -0.2, 0.5, -0.2, 2.0;
  const Vector3d v(1.0, -2.0, 3.0);
  const AllocationGuard guard;
  const Vector3d solved = m.ldlt().solve(v);
  const Matrix3d inverse = m.inverse();
  const auto calls = guard.calls();
  CHECK(calls == 0);
  CHECK((m * solved - v).norm() < 1e-12);
  CHECK((m * inverse - Matrix3d::Identity()).norm() < 1e-12);
}
