#pragma once
// Where what a scan shows of a body says that the body is.
#include "planner/tracking/detection.h"

namespace jaywalk {
/// What one scan says of a body: one detection, or a person's two legs. A field a measurement, so more of them than a
/// struct has elsewhere.
struct Observation {
  Vec2 position_in_map;
  double late_s = 0.0, late_std_s = 0.0;  ///< Detection's: when it was there
  double std_m = 0.0;                     ///< an axis, as expected of its kind; Target::noise tells what comes of it
  double off_std_m = 0.0;                 ///< besides, an axis: Target's
  double radius_m = 0.0;
  bool in_free_space = false;
  Outline outline_in_map;  ///< of the nearest detection
  BeamRun beams{};         ///< of the same
  bool whole = false;      ///< nothing hid either side of that
  int hidden_side = 0;     ///< Detection::hidden_side of that
  bool on_wall = false;    ///< that stands where walls stand
  double width_m = 0.0;    ///< of what is seen of that
  double spacing_m = 0.0;  ///< from beam to beam, across them
  double arc_m = 0.0;      ///< half its width across the beams where it is whole and no leg; else 0
  bool two_legs = false;   ///< apart, with nothing before either
  bool lone_leg = false;   ///< one leg alone
  Vec2 was_off;            ///< m: how far from there one side alone has had it until now that both are seen
};

/// `lead` alone, or it and another leg, `fellow`, -1 for none. `arc_m`, `on_legs`: Target's.
[[nodiscard]] Observation observation_of(const Detections& detections, std::size_t lead, std::int32_t fellow,
                                         double arc_m, bool on_legs) noexcept;

/// From where one side of `c` had its middle while its width was not known (`hidden_side`: Target's), to where both
/// have it.
[[nodiscard]] Vec2 off_by_one_side(const Detection& c, int hidden_side) noexcept;

}  // namespace jaywalk
