#pragma once
#include "planner/localization/coasting.h"

namespace jaywalk {

/// Whether the pose is still good: not after a gap, a stall of the program or wheels that were silent, since coasting
/// is a guess; once what it may be off by is more than a scan matcher sorts out, a wall that fits is as likely a wrong
/// one. Nor where the robot was carried.
///
/// It ends with wheels whose angles count on from before a gap, or with a fix: a carried robot that looked for its
/// place on the map by itself found wrong ones that fit, 7 and 11 m off. Until then nothing is matched or mapped.
/// Thread: the loop's.
class PoseDoubt {
 public:
  /// It went on as guessed.
  void coasted(const Coasting::Step& step) noexcept;
  /// A scan was found in the map.
  void matched() noexcept {
    if (!is_doubtful()) settle();
  }
  /// It was lifted, pushed or turned by hand: its wheels do not know.
  void carried() noexcept { carried_ = true; }
  /// Its way through the gap is known after all.
  void counted_on() noexcept { position_var_ = heading_var_ = 0.0, doubtful_ = false; }
  /// Where it is now is known.
  void settle() noexcept { *this = {}; }

  [[nodiscard]] bool is_doubtful() const noexcept { return doubtful_ || carried_; }

 private:
  double position_var_ = 0.0, heading_var_ = 0.0;  ///< of what was guessed since the last match, m^2 and rad^2
  bool doubtful_ = false;                          ///< these are too great
  bool carried_ = false;
};

}  // namespace jaywalk
