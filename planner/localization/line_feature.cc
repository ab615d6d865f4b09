#include "planner/localization/line_feature.h"

#include <algorithm>
#include <cmath>

#include "hal/types/fixed_vector.h"

namespace jaywalk {
namespace {

constexpr double kNearM = 0.25;      // a wall's points about a scan's point
constexpr std::int32_t kReach = 3;   // cells to each side that may hold them
constexpr double kThinWallM = 0.06;  // standard deviation across: a wall seen with 5 cm of noise; thicker things have
                                     // no direction
constexpr double kPointStdM = 0.02;  // range noise and the map's own roughness
// A face looked at along itself seems to be seen from a little behind it: the sine of how far, 10 degrees. By trial.
constexpr double kFromBehind = 0.17;

bool has_surface(const EvidenceMap& still, CellIndex cell) { return still.evidence(cell) > 0; }

struct Surface {
  Vec2 at;  ///< from the anchor
  Vec2 to_laser;
};
using Surfaces = FixedVector<Surface, (2 * kReach + 1) * (2 * kReach + 1)>;

/// The cell of the surface point nearest to `p`; false where none is near.
bool anchor_near(const EvidenceMap& still, Vec2 p, CellIndex& anchor) {
  const CellIndex cell = still.cell_at(p);
  double nearest = kNearM;
  bool any = false;
  for (std::int32_t j = -1; j <= 1; ++j) {
    for (std::int32_t i = -1; i <= 1; ++i) {
      const CellIndex c{cell.i + i, cell.j + j};
      if (!has_surface(still, c)) continue;
      const double d = distance(still.surface(c), p);
      if (d < nearest) nearest = d, anchor = c, any = true;
    }
  }
  return any;
}

void surfaces_about(const EvidenceMap& still, Vec2 anchor, Surfaces& out) {
  const CellIndex middle = still.cell_at(anchor);
  for (std::int32_t j = -kReach; j <= kReach; ++j) {
    for (std::int32_t i = -kReach; i <= kReach; ++i) {
      const CellIndex c{middle.i + i, middle.j + j};
      if (!has_surface(still, c)) continue;
      const Vec2 d = still.surface(c) - anchor;
      if (dot(d, d) <= kNearM * kNearM) (void)out.push_back({d, still.to_laser(c)});
    }
  }
}

struct Line {
  Vec2 mean, normal;
  double across = 0.0, along = 0.0;  ///< variances, m^2
};

/// By their covariance. False for fewer than two, and for those that spread alike all ways.
bool line_through(const Surfaces& surfaces, Line& out) {
  double n = 0.0, sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0, syy = 0.0;
  for (const Surface& s : surfaces) {
    const Vec2 d = s.at;
    n += 1.0, sx += d.x, sy += d.y, sxx += d.x * d.x, sxy += d.x * d.y, syy += d.y * d.y;
  }
  if (n < 2.0) return false;
  out.mean = {sx / n, sy / n};
  const Vec2& mean = out.mean;
  const double cxx = sxx / n - mean.x * mean.x, cxy = sxy / n - mean.x * mean.y, cyy = syy / n - mean.y * mean.y;
  const double half_spread = std::sqrt(0.25 * (cxx - cyy) * (cxx - cyy) + cxy * cxy);
  out.across = std::max(0.0, 0.5 * (cxx + cyy) - half_spread), out.along = 0.5 * (cxx + cyy) + half_spread;
  // The eigenvector of the smaller eigenvalue, from the longer of the matrix's two rows.
  const Vec2 normal = cxx < cyy ? Vec2{out.across - cyy, cxy} : Vec2{cxy, out.across - cxx};
  const double length = norm(normal);
  if (!(length > 0.0)) return false;
  out.normal = normal * (1.0 / length);
  return true;
}

/// Leaves out what was seen from behind the line. True where something was.
bool drop_other_face(Surfaces& surfaces, Vec2 normal_to_viewer) {
  std::size_t kept = 0;
  for (const Surface& s : surfaces) {
    if (dot(normal_to_viewer, s.to_laser) > -kFromBehind) surfaces[kept++] = s;
  }
  const bool dropped = kept < surfaces.size();
  surfaces.truncate(kept);
  return dropped;
}

}  // namespace

bool line_feature_near(const EvidenceMap& still, Vec2 p, Vec2 viewer, LineFeature& out) noexcept {
  CellIndex nearest;
  if (!anchor_near(still, p, nearest)) return false;
  const Vec2 anchor = still.surface(nearest);
  Surfaces surfaces;
  surfaces_about(still, anchor, surfaces);
  Line line;
  if (!line_through(surfaces, line)) return false;
  const double side = dot(line.normal, viewer - anchor) < 0.0 ? -1.0 : 1.0;
  if (drop_other_face(surfaces, line.normal * side) && !line_through(surfaces, line)) return false;
  if (line.across > kThinWallM * kThinWallM || line.along < 4.0 * line.across) return false;
  out = {anchor + line.mean, line.normal, line.across + kPointStdM * kPointStdM, still.stands(nearest)};
  return true;
}

}  // namespace jaywalk
