#pragma once

namespace jaywalk {

/// What the supervisor's stop zone lets the robot do near a surface; roll-outs foresee the same. T: double to the
/// supervisor, float to the roll-outs.
template <class T>
struct StopZoneRules {
  static constexpr T kMargin_m = T(0.08);       ///< kept free round the footprint at kFull_mps of its rim and above
  static constexpr T kCreepMargin_m = T(0.04);  ///< the same at rest; in between in proportion: it passes a door
                                                ///< closely, but slowly
  static constexpr T kFull_mps = T(0.4);
  /// Greatest speed of the rim, m/s, with `gap_m` free before it.
  [[nodiscard]] static constexpr T permitted_rim(T gap_m) noexcept {
    const T over = gap_m > kCreepMargin_m ? gap_m - kCreepMargin_m : T(0);
    return over / (kMargin_m - kCreepMargin_m) * kFull_mps;
  }
  /// Beside what is nearer than kBeside_m already, the rim may creep: no nearer than that by more than kSwing_m, nor
  /// nearer than kLeast_m.
  static constexpr T kBeside_m = T(0.07), kCreep_mps = T(0.1), kSwing_m = T(0.01), kLeast_m = T(0.02);
};

}  // namespace jaywalk
