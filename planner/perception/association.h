#pragma once
// Which cluster is which body's, and where that says the body is.
#include "planner/perception/bodies.h"
#include "planner/perception/clusters.h"

namespace jaywalk {

/// What one scan says of a body: one cluster, or a person's two legs.
struct Observation {
  Vec2 position_in_map;
  double std_m = 0.0;  ///< an axis, as expected of its kind; Body::noise tells what comes of it
  double radius_m = 0.0;
  bool in_free_space = false;
  Outline outline_in_map;  ///< of the nearest cluster
  BeamRun beams{};         ///< of the same
  bool whole = false;      ///< nothing hid either side of that
  int hidden_side = 0;     ///< Cluster::hidden_side of that
  bool on_wall = false;    ///< that stands where walls stand
  double edge_m = 0.0;     ///< Body::edge_m
  double width_m = 0.0;    ///< of what is seen of that
  double spacing_m = 0.0;  ///< from beam to beam, across them
  double arc_m = 0.0;      ///< half its width across the beams where it is whole and no leg; else 0
  Vec2 was_off;            ///< m: how far from there one side alone has had it until now that both are seen
};

/// Cuts segments where one known body ends and the next begins: whoever passes another so near that no jump parts them.
/// A segment is cut that begins on one and ends on another, one of which moves at least, and that is about as wide as
/// both. When the list is full, its rest counts as wall.
void cut_between(const Bodies& bodies, const PointsInMap& in_map, Segments& segments) noexcept;

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
