#pragma once
#include <cstdint>
#include <string>

#include "firmware/recording/tick_record.h"
#include "hal/hal.h"
#include "hal/types/robot_model.h"
#include "planner/localization/place_search.h"

namespace jaywalk {

/// Fixes from a person's word on where the robot is, once PlaceCheck has taken it: the only ones of a robot without a
/// localisation system outside it. Thread: the loop's.
class ToldPlace final : public PoseSource {
 public:
  // A person's eye on a plan; within what a scan matcher puts right (correlative_search.cc).
  ToldPlace() noexcept { fix_.position_std_m = 0.13, fix_.heading_std_rad = 0.1; }

  /// Said three times, in as many ticks: the localizer passes one fix over that is far from where it believes to be.
  void tell(const Pose2& map_from_robot) noexcept {
    fix_.map_from_robot = map_from_robot;
    fix_.has_pose = true;
    left_ = kTimes;
  }
  /// Of the tick that begins at `now`.
  void step(Time now) noexcept {
    if (left_ == 0) return;
    --left_;
    fix_.stamp = now;
    ++fix_.sequence;
  }
  [[nodiscard]] const OutsideFix& latest() noexcept override { return fix_; }

 private:
  static constexpr int kTimes = 3;
  OutsideFix fix_;
  int left_ = 0;
};

/// A person's word on where the robot is.
struct ToldPlaceOrder {
  std::uint32_t number = 0;  ///< of the order
  Pose2 map_from_robot;
  bool forced = false;  ///< taken without a match
};

/// Answer to a ToldPlaceOrder.
struct PlaceAnswer {
  enum class Why : std::uint8_t {
    kFits,       ///< taken, where the scan matches the map
    kUnknown,    ///< taken as told: the map knows too little there
    kForced,     ///< taken as told
    kPoor,       ///< the scan does not fit there
    kElsewhere,  ///< it fits elsewhere, and clearly better
    kMoved       ///< the robot did not stand
  };
  std::uint32_t number = 0;
  Why why = Why::kPoor;
  Pose2 map_from_robot;  ///< taken
  double fit = 0.0;      ///< share of what the map knows there that the scan fits
  bool has_better = false;
  Pose2 better;  ///< a place that fits

  [[nodiscard]] bool is_taken() const noexcept { return why <= Why::kForced; }
};

/// "there", or "refused: " with cause and remedy.
[[nodiscard]] std::string words_of(const PlaceAnswer& answer);

/// A person's word on where the robot is, held against the map: matched there, and searched for elsewhere
/// (PlaceSearch), which takes seconds. Thread: the loop's; only the constructor allocates.
class PlaceCheck {
 public:
  explicit PlaceCheck(const RobotModel& model) : model_(model) {}

  void begin(const ToldPlaceOrder& order) noexcept;
  /// After each tick. True when the answer is there.
  [[nodiscard]] bool step(const TickRecord& t, const EvidenceMap& still) noexcept;
  [[nodiscard]] const PlaceAnswer& answer() const noexcept { return answer_; }

 private:
  void look(const TickRecord& t, const EvidenceMap& still) noexcept;
  void decide() noexcept;
  void end(PlaceAnswer::Why why) noexcept;

  RobotModel model_;
  ToldPlaceOrder order_;
  bool asked_ = false, ended_ = false;
  ScanProjection projection_;
  ScanPoints points_;
  SeenSample sample_;
  PlaceSearch search_;
  PlaceFit there_, other_;  ///< where it was told to be; the best elsewhere: where it was believed, or was found
  double left_rad_ = 0.0, right_rad_ = 0.0;  ///< of the wheels when it looked
  PlaceAnswer answer_;
};

}  // namespace jaywalk
