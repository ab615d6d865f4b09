#pragma once
// A person with a stick, scripted: what drives a simulated robot by hand, so that anyone can repeat it.
#include <cstdint>
#include <vector>

#include "hal/sim/random.h"
#include "hal/sim/scenario.h"
#include "hal/types/operator_input.h"

namespace jaywalk::sim {

struct Truth;

/// Holds a stick full ahead whatever comes, points it at the goal, or moves it by a table. What the hand does comes
/// late, and trembles. Thread: the simulation's.
class ScriptedStick {
 public:
  /// Throws StartupError for a table that is none.
  ScriptedStick(const StickSpec& spec, const Scenario& scenario, std::uint64_t seed);

  /// Where the stick stands now; call with times that do not fall.
  [[nodiscard]] Stick at(const Truth& truth) noexcept;

 private:
  struct Row {
    double t_s = 0.0;
    Stick stick;
  };

  [[nodiscard]] Stick meant(const Truth& truth) const noexcept;
  [[nodiscard]] Stick meant_to_goal(const Truth& truth) const noexcept;
  [[nodiscard]] Stick delayed(double now_s) noexcept;
  void tremble(double dt_s) noexcept;

  StickSpec spec_;
  Vec2 goal_;
  double arrives_within_m_;
  std::vector<Row> table_;
  std::vector<Row> meant_;  ///< what was meant within the last second: a ring
  std::size_t next_ = 0;
  Random random_;
  double off_forward_ = 0.0, off_left_ = 0.0;  ///< of the hand
  double before_s_ = 0.0;
};

}  // namespace jaywalk::sim
