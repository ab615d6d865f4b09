#pragma once
#include "planner/localization/coasting.h"

namespace jaywalk {

/// Whether the pose is still good after a gap: a stall of the program, or wheels that were silent. Coasting is a guess;
/// once what it may be off by is more than a scan matcher sorts out, a wall that fits is as likely a wrong one.
///
/// It ends with wheels whose angles count on from before the gap, or with a fix from outside. Until then nothing is
/// matched or mapped. Thread: the loop's.
class PoseDoubt {
 public:
  /// It went on as guessed.
  void coasted(const Coasting::Step& step) noexcept;
  /// A scan was found in the map.
  void matched() noexcept {
    if (!doubtful_) settle();
  }
  /// Its way through the gap is known after all, or where it is now.
  void settle() noexcept { *this = {}; }

  [[nodiscard]] bool is_doubtful() const noexcept { return doubtful_; }

 private:
  double position_var_ = 0.0, heading_var_ = 0.0;  ///< of what was guessed since the last match, m^2 and rad^2
  bool doubtful_ = false;
};

}  // namespace jaywalk
