#include "firmware/robot/said_goals.h"

#include <algorithm>

namespace jaywalk {

bool SaidGoals::is_void(std::string_view words, std::uint32_t revoked, Time now) {
  static constexpr Duration kSame = std::chrono::seconds(kSame_s);
  std::erase_if(goals_, [now](const Said& goal) { return age(goal.last, now) > kSame; });
  const auto said =
      std::find_if(goals_.begin(), goals_.end(), [words](const Said& goal) { return goal.words == words; });
  if (said == goals_.end()) {
    if (goals_.size() == kMost) goals_.erase(goals_.begin());
    goals_.push_back({.words = std::string(words), .revoked = revoked, .last = now});
    return false;
  }
  said->last = now;
  const bool is_same = said->revoked == revoked;
  if (said->is_repeated && !is_same) return true;
  said->is_repeated = is_same;
  said->revoked = revoked;
  return false;
}

}  // namespace jaywalk
