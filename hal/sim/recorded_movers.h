#pragma once
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "hal/sim/simulation.h"
#include "hal/sim/zone.h"

namespace jaywalk::sim {

/// People who walked somewhere once and walk so again: straight between the recorded places, there from their first
/// row to their last. They heed nobody. A person counts as forced when the robot comes into the zone ahead
/// (kRecordedZone); standing ones look where they last walked.
class RecordedMovers {
 public:
  /// Reads t_s,id,x_m,y_m files; the simulation's movers get the ids after `last_id`. Throws StartupError.
  RecordedMovers(std::span<const RecordedSpec> specs, std::uint32_t last_id);

  void place(double now_s, const RobotBody& robot) noexcept;

  /// The movers that are there now.
  [[nodiscard]] std::span<const MoverTruth> movers() const noexcept { return present_; }
  /// Most that can be there at once.
  [[nodiscard]] std::size_t capacity() const noexcept { return people_.size(); }
  [[nodiscard]] std::uint32_t forced() const noexcept { return forced_; }

 private:
  struct Sample {
    double t_s;
    Vec2 position;
  };
  struct Person {
    std::vector<Sample> samples;  ///< in order of time
    std::size_t next = 1;         ///< sample that comes after the present time
    const RecordedSpec* spec;
    double begin_s, period_s;  ///< of the whole recording
    MoverTruth truth;
  };

  void load(const RecordedSpec& spec);
  [[nodiscard]] static bool move(Person& person, double now_s) noexcept;

  std::vector<RecordedSpec> specs_;
  std::vector<Person> people_;
  std::vector<MoverTruth> present_;
  std::uint32_t forced_ = 0;
};

}  // namespace jaywalk::sim
