#pragma once
// Which cluster is which body's, and where that says the body is.
#include "planner/tracking/bodies.h"
#include "planner/tracking/observation.h"

namespace jaywalk {

/// Gives every cluster to the likeliest body within its gate (Cluster::track_id), of two as near by their own doubt to
/// the surer one; several may share one. Order of bodies and clusters does not matter except between exact equals.
void associate(const Bodies& bodies, Clusters& clusters) noexcept;

/// What the clusters given to `body` say together. Its nearest cluster leads; when it is a leg, the nearest
/// other leg within a stride joins it. Clusters that are left over and too far to belong are set free again.
/// False when it got none.
bool observe(const Body& body, Clusters& clusters, Observation& out) noexcept;

/// A new body's observation from free cluster `index` and, for a leg, its nearest free fellow; both are given to
/// the track that it becomes. False, and nothing changes, when the cluster is sparse and has no fellow.
[[nodiscard]] bool observe_new(Clusters& clusters, std::size_t index, std::uint32_t becomes_track_id,
                               Observation& out) noexcept;

}  // namespace jaywalk
