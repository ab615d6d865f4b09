#pragma once
#include <string>

#include "hal/types/robot_model.h"
#include "hal/types/time.h"

namespace jaywalk {

/// Reports that a base shows in its arming proof, while it is told to stand: how many, how late, and of what speed.
class ShownReports {
 public:
  /// `tick`: how often they are read.
  ShownReports(const DriveTimes& times, Duration tick) noexcept : times_(times), tick_(tick) {}

  void begin(Time now) noexcept;
  void note(Time now, double speed_radps) noexcept;
  /// Long enough to tell how often it reports.
  [[nodiscard]] bool is_over(Time now) const noexcept { return now - began_ >= shown_for(); }
  /// As often as stated.
  [[nodiscard]] bool is_often_enough() const noexcept;
  [[nodiscard]] double per_second() const noexcept;
  [[nodiscard]] double fastest_radps() const noexcept { return fastest_radps_; }
  /// Periods and delays that it showed, for the robot file; or that no robot file can have them. Start-up only.
  [[nodiscard]] std::string remedy() const;

 private:
  [[nodiscard]] Duration shown_for() const noexcept;

  DriveTimes times_;
  Duration tick_;
  Time began_ = kNever, read_ = kNever;
  int readings_ = 0;
  Duration longest_{};  ///< between two
  double fastest_radps_ = 0.0;
};

}  // namespace jaywalk
