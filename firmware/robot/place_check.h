#pragma once
#include <cstdint>
#include <string>

#include "firmware/recording/tick_record.h"
#include "hal/types/robot_model.h"
#include "planner/localization/place_search.h"

namespace jaywalk {

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
