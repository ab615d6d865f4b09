#include "planner/tracking/steady_walk.h"

#include <algorithm>

namespace jaywalk {
namespace {

constexpr double kMostlyFree = 0.7;  // of its places in free space
constexpr double kSolidSigmas = 7.0, kThingSigmas = 15.0;
// The same of bodies that came to free space: no false mover in no_people_left.
constexpr double kCameSigmas = 4.5, kCameM = 0.06;
constexpr double kRigidShare = 0.3;  // of its walk is all that its width changes by
constexpr double kSideShare = 0.4;   // of its way is the least that a seen side went: 0.3 and 0.5 tell as much
// Of what it grew by, where nobody says that it came: a surface that comes into view on one side and goes out of it on
// the other: at a quarter of the headings of no_people_left. 1.5 to 3 tell as much.
constexpr double kGrewUnfree = 2.0;
constexpr double kEdges = 1.5;  // beam spacings: where its seen side is, is known to one

/// Comes out from behind something wider than legs, which no leg that takes its turn does. Its free side is where its
/// path is measured, and a surface that comes into view has that where it always was.
bool emerges(const Body& body) { return body.edge_m > 0.0 && body.noise < Body::kSolidNoise; }

/// The least of a steady walk that is believed.
struct LeastWalk {
  double sigmas = 0.0, length_m = 0.0;
};

LeastWalk least_walk(const Body& body, const StraightWalk& walk) {
  if (!body.solid() && !emerges(body)) return {kThingSigmas, kSteadyM};
  if (came_to_free_space(body) && walk.explained > kStraightExplains) return {kCameSigmas, kCameM};
  return {kSolidSigmas, kSteadyM};
}

/// One side of the body went from `then` to `now`: along its way, or not.
bool went_along(const Body& body, Vec2 then, Vec2 now) {
  const Vec2 way = body.track.position_in_map - body.anchor_in_map;
  return dot(now - then, way) > kSideShare * dot(way, way);
}

/// Each side that is seen and was seen where it set out went along.
bool seen_sides_went(const Body& body) {
  if (body.anchor_outline.empty() || body.outline_in_map.empty()) return true;
  const bool low = body.low_seen() && body.anchor_low_seen, high = body.high_seen() && body.anchor_high_seen;
  return (!low || went_along(body, body.anchor_outline[0], body.outline_in_map[0])) &&
         (!high || went_along(body, body.anchor_outline.back(), body.outline_in_map.back()));
}

}  // namespace

bool came_to_free_space(const Body& body) noexcept { return body.free_share > kMostlyFree; }

bool steady(const Body& body, const StraightWalk& walk) noexcept {
  const LeastWalk least = least_walk(body, walk);
  const double grew_m = walk.width_change_m * (came_to_free_space(body) ? 1.0 : kGrewUnfree);
  return walk.sigmas > least.sigmas && seen_sides_went(body) &&
         walk.length_m > std::max({least.length_m, grew_m, kEdges * body.edge_m});
}

double least_steady_m(const Body& body, const StraightWalk& walk) noexcept { return least_walk(body, walk).length_m; }

bool keeps_its_width(const StraightWalk& walk, double change_m) noexcept {
  return change_m < kRigidShare * walk.length_m;
}

bool rigid(const Body& body, const StraightWalk& walk) noexcept {
  const bool both_sides = body.whole && walk.whole_places >= kFewestSteady;
  return both_sides && body.solid() && steady(body, walk) && keeps_its_width(walk, walk.width_change_m);
}

bool edge_walks(const Body& body, const StraightWalk& walk) noexcept { return emerges(body) && steady(body, walk); }

}  // namespace jaywalk
