#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hal/types/fixed_vector.h"
#include "hal/types/operator_input.h"
#include "hal/types/time.h"

namespace jaywalk {

/// Where an operator tells a robot to go.
struct GoalOrder {
  Vec2 position_in_map;
  double heading_rad = kAnyHeading;  ///< in (-pi, pi]; NaN: any
};

/// From "X Y" or "X Y HEADING", separated by spaces; metres, radians, at most a turn either way. Throws StartupError
/// "goto: cause; remedy" for anything else. Not for the loop.
[[nodiscard]] GoalOrder read_goal_order(std::string_view words);

/// A place that has a name in the robot file.
struct NamedPlace {
  std::string name;
  GoalOrder order;
};

/// Goals one after the other; at most 16, as many as a person gives in one line.
using Route = FixedVector<GoalOrder, 16>;

/// Whether a word may be a place's name: it begins with a letter. A name among numbers is a number mistyped.
[[nodiscard]] bool is_place_name(std::string_view word);

/// From words of read_goal_order(), or names of `places` in the order to go there. Throws likewise. Not for the loop.
[[nodiscard]] Route read_route(std::string_view words, std::span<const NamedPlace> places);

/// Its words: read_goal_order() gives the same order.
[[nodiscard]] std::string words_of(const GoalOrder& order);

/// List of the goals that clients asked for lately: repeating a goal gives one order, and a stop voids that order.
///
/// A goal that came twice within kSame_s is repeated, by a script or a bridge say; after a stop it is void until it has
/// not come for kSame_s. One that came once may be a person's and counts again. Not for the loop's thread.
class SaidGoals {
 public:
  /// Longest time between two repetitions, s: five times the usual second.
  static constexpr int kSame_s = 5;

  /// Notes a goal; `revoked`: Permission::revoked() at this time. True where a revocation has voided it.
  [[nodiscard]] bool is_void(std::string_view words, std::uint32_t revoked, Time now);

 private:
  static constexpr std::size_t kMost = 64;  ///< the oldest is forgotten for one more
  struct Said {
    std::string words;
    std::uint32_t revoked = 0;  ///< revocations when it last counted
    Time last = kNever;
    bool is_repeated = false;
  };
  std::vector<Said> goals_;
};

}  // namespace jaywalk
