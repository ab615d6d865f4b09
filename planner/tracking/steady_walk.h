#pragma once
// Walks so straight for their length that there is no doubt left: a slow robot is both slow and straight, a person
// fast and swaying.
#include "planner/tracking/bodies.h"

namespace jaywalk {

/// A straight walk explains so much of its places' scatter; one hop in the middle reaches 0.75.
inline constexpr double kStraightExplains = 0.8;
/// The shortest steady walk, where nothing more is known.
inline constexpr double kSteadyM = 0.10;

/// Places of a steady walk, and of those at which both its sides must have been seen: of what was seen whole once, the
/// side that came into view seems to go along.
inline constexpr std::size_t kFewestSteady = 4;

/// It was seen where nothing stood before, most of the time.
[[nodiscard]] bool came_to_free_space(const Body& body) noexcept;

/// Whether `walk`, of the places of `body`, is so many of its standard deviations long that it is one, and longer than
/// growing or shrinking explains. The more the body and the ground tell, the shorter it may be. A side that is seen,
/// and was seen where the walk began, must have gone along: what comes into view of a thing that stands leaves it
/// there.
[[nodiscard]] bool steady(const Body& body, const StraightWalk& walk) noexcept;

/// The shortest walk of `body` that is steady, m.
[[nodiscard]] double least_steady_m(const Body& body, const StraightWalk& walk) noexcept;

/// Whether a width that changed by `change_m` meanwhile is the same, to what a walk so long tells.
[[nodiscard]] bool keeps_its_width(const StraightWalk& walk, double change_m) noexcept;

/// Steady, and both sides of a body went along, of which nothing hides either: no surface that comes into view does so.
[[nodiscard]] bool rigid(const Body& body, const StraightWalk& walk) noexcept;

/// Steady, of one who comes out from behind something. What the side that is seen went says more, and sooner, than a
/// filter that does not know yet how wide the body is.
[[nodiscard]] bool edge_walks(const Body& body, const StraightWalk& walk) noexcept;

}  // namespace jaywalk
