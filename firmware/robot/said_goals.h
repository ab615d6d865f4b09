#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "hal/types/time.h"

namespace jaywalk {

/// List of the goals that clients asked for lately: repeating a goal gives one order, and a stop voids that order.
///
/// A script or a bridge may send its goal again and again, stop or no stop. A goal that came twice within kSame_s is
/// repeated; after a stop it is void until it has not come for kSame_s. A goal that came once may be a person's and
/// counts again after a stop. Not for the loop's thread.
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
