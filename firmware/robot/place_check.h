#pragma once
// A person's word on where the robot is and what it may do.
#include <cstdint>
#include <optional>
#include <string>

#include "firmware/recording/tick_record.h"
#include "firmware/robot/goal_order.h"
#include "firmware/safety/reasons.h"
#include "hal/hal.h"
#include "hal/types/robot_model.h"
#include "planner/localization/place_search.h"

namespace jaywalk {

/// Fixes from a person's word on where the robot is, once PlaceCheck has taken it: the only ones of a robot without a
/// localisation system outside it. Thread: the loop's.
class ToldPlace final : public PoseSource {
 public:
  /// A person's eye on a plan; within what a scan matcher puts right (correlative_search.cc).
  static constexpr double kEye_m = 0.13, kEye_rad = 0.1;

  ToldPlace() noexcept { fix_.position_std_m = kEye_m, fix_.heading_std_rad = kEye_rad; }

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

/// What a person asks for in one breath.
struct Orders {
  std::uint32_t under = 0;  ///< revocations that the asker had been told of (Permission::revoked())
  Route route{};            ///< empty: nowhere to go
  bool reset = false;
  std::optional<Pose2> here{};  ///< where the robot is, in the map
  bool forced = false;          ///< taken without a match
  std::uint32_t number = 0;     ///< counted from 1
};

/// Answer to a place that was told.
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

  /// After each tick; `told`: a place to check from now on. True when the answer is there.
  [[nodiscard]] bool step(const std::optional<Orders>& told, const TickRecord& t, const EvidenceMap& still) noexcept;
  [[nodiscard]] const PlaceAnswer& answer() const noexcept { return answer_; }

 private:
  // True when the answer is there.
  bool look(const TickRecord& t, const EvidenceMap& still) noexcept;
  bool decide() noexcept;
  bool end(PlaceAnswer::Why why) noexcept;

  RobotModel model_;
  Orders order_;
  ScanProjection projection_;
  ScanPoints points_;
  SeenSample sample_;
  PlaceSearch search_;
  PlaceFit there_, other_;  ///< where it was told to be; the best elsewhere: where it was believed, or was found
  double left_rad_ = 0.0, right_rad_ = 0.0;  ///< of the wheels when it looked
  PlaceAnswer answer_;
};

/// Orders in force and those that wait: one struct that every order, stop, fault and latch assigns anew, so that
/// nothing given before is left. A stop is obeyed to rest: until then nothing is given, and a stick counts from its
/// middle on. Orders given, in other threads, before the last revocation are void. Thread: the loop's.
class Permission {
 public:
  /// Takes the place of all that was given before, a reset that waits among it. False: void, and nothing is given.
  bool give(const Orders& orders) noexcept {
    given_ = {};
    if (stopping_ || orders.under != revoked_) return false;
    given_.route = orders.route;
    return true;
  }
  void revoke() noexcept {
    revokes_reset_ = revokes_reset_ || given_.reset_waits;
    given_ = {};
    ++revoked_;
  }
  /// A person's order to stop.
  void stop() noexcept {
    revoke();
    stopping_ = true;
  }
  /// After each tick: whether the robot stands and is told to.
  void note_rest(bool at_rest) noexcept { stopping_ = stopping_ && !at_rest; }
  [[nodiscard]] bool is_stopping() const noexcept { return stopping_; }
  /// Once a tick: what counts of where a stick stands.
  [[nodiscard]] Stick admitted(const Stick& stick) noexcept {
    stick_waits_ = (stick_waits_ || stopping_) && !stick.is_centred();
    return stick_waits_ ? Stick{} : stick;
  }
  /// A tick's verdict: a latch, and a fault that comes while latched, revoke. True where it latched, or where a reset
  /// that waited was revoked in this tick: by these reasons it stands.
  bool judge(Reason reasons) noexcept;
  /// How often, so far.
  [[nodiscard]] std::uint32_t revoked() const noexcept { return revoked_; }

  void let_reset_wait() noexcept { given_.reset_waits = true; }
  [[nodiscard]] bool reset_waits() const noexcept { return given_.reset_waits; }
  void reset_is_done() noexcept { given_.reset_waits = false; }

  /// The goal that is driven to; none: nullptr.
  [[nodiscard]] const GoalOrder* goal() const noexcept {
    return given_.leg < given_.route.size() ? &given_.route[given_.leg] : nullptr;
  }
  void goal_is_reached() noexcept { given_.leg += goal() != nullptr ? 1U : 0U; }
  /// That one among them.
  [[nodiscard]] std::size_t goals_left() const noexcept { return given_.route.size() - given_.leg; }

 private:
  struct Given {
    Route route;
    std::size_t leg = 0;       ///< of the route that is driven
    bool reset_waits = false;  ///< until the drives are proved
  };

  Given given_;
  std::uint32_t revoked_ = 0;
  bool revokes_reset_ = false;  ///< in this tick
  bool stopping_ = false;       ///< ordered to, and not at rest since
  bool stick_waits_ = false;    ///< for its middle
  bool latched_ = false;
  Reason faults_ = Reason::kNone;  ///< of the tick before
};

}  // namespace jaywalk
