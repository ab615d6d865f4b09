#pragma once
// Whoever stands: as wide as he is, though the map has no more of him than his shins.
#include "hal/types/fixed_vector.h"
#include "planner/mapping/evidence_map.h"
#include "planner/tracking/bodies.h"
#include "planner/scan/line_of_sight.h"
#include "planner/tracking/stander.h"

namespace jaywalk {

using Standers = FixedVector<Stander, kMaxTracks>;

/// Who of the bodies may be somebody (Body::somebody) and does not move stands where he was seen last. Who was noted
/// before and is none of them any more stands there for as long as the map has something as near to his middle as legs
/// are, or a body stands so near, however little of him it is; or while he may be hidden there, for kRememberedS.
/// Bodies come first; of the others as many as there is room for, the latest first.
void note_standers(const Bodies& bodies, const EvidenceMap& still, const LineOfSight& sight, Time now,
                   Standers& standers) noexcept;

}  // namespace jaywalk
