#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "hal/types/time.h"

namespace jaywalk {

/// Goals that clients asked for lately, by their words: one that is being repeated is one order, and void once revoked.
///
/// A client that knows nothing of stops says its goal again and again: a script, a bridge. A goal that is said twice
/// within kSame_s is such an order; revoked, it is void until it was not said for as long. One that was said once may
/// be a person's, who says it again after a stop. Not for the loop's thread.
class SaidGoals {
 public:
  /// Clients repeat once a second; five times as long, so that a slow one is known for what it is.
  static constexpr int kSame_s = 5;

  /// Notes that it was said, after so many revocations (Permission::revoked()); whether one has made it void.
  [[nodiscard]] bool is_void(std::string_view words, std::uint32_t revoked, Time now);

 private:
  static constexpr std::size_t kMost = 64;  ///< the oldest is forgotten for one more
  struct Said {
    std::string words;
    std::uint32_t revoked = 0;  ///< then
    Time last = kNever;
    bool is_repeated = false;
  };
  std::vector<Said> goals_;
};

}  // namespace jaywalk
