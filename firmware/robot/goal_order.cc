#include "firmware/robot/goal_order.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "hal/setting_keys.h"
#include "hal/shown_text.h"
#include "hal/types/errors.h"

namespace jaywalk {
namespace {

constexpr double kFarthest_m = 1e5;   ///< a goal beyond is a slip of the finger
constexpr double kTurn_rad = 6.2832;  ///< a heading beyond is one in degrees

std::vector<std::string> split(std::string_view text) {
  std::vector<std::string> words;
  for (std::size_t at = 0; (at = text.find_first_not_of(' ', at)) != std::string_view::npos;) {
    const std::size_t end = std::min(text.find(' ', at), text.size());
    words.emplace_back(text.substr(at, end - at));
    at = end;
  }
  return words;
}

/// A number of at most `most` either way; `what` it is, for complaints.
double read_number(const std::string& word, const std::string& what, double most, const std::string& remedy) {
  const auto value = number_in<double>(word);
  const std::string place = "goto: " + what + " " + word;
  if (!value) throw StartupError(place + " is no number", remedy);
  if (!std::isfinite(*value)) throw StartupError(place + " is not finite", remedy);
  if (std::fabs(*value) > most) throw StartupError(place + " is out of range", remedy);
  return *value;
}

}  // namespace

GoalOrder read_goal_order(std::string_view text) {
  const std::vector<std::string> words = split(text);
  if (words.size() != 2 && words.size() != 3) {
    throw StartupError("goto: " + std::to_string(words.size()) + " words make no goal",
                       "give X Y, X Y HEADING, or names of places");
  }
  const std::string metres = "give metres in the map, at most 100000";
  GoalOrder order;
  order.position_in_map = {read_number(words[0], "X", kFarthest_m, metres),
                           read_number(words[1], "Y", kFarthest_m, metres)};
  if (words.size() == 3) {
    order.heading_rad =
        wrap_angle(read_number(words[2], "HEADING", kTurn_rad, "give radians in the map, a turn (6.2832) at most"));
  }
  return order;
}

bool is_place_name(std::string_view word) {
  if (word == "nan" || word == "inf") return false;  // what a goal's numbers may be by mistake
  const char first = word.empty() ? '0' : word.front();
  return (first >= 'a' && first <= 'z') || (first >= 'A' && first <= 'Z');
}

Route read_route(std::string_view text, std::span<const NamedPlace> places) {
  const std::vector<std::string> words = split(text);
  Route route;
  if (words.empty() || !std::all_of(words.begin(), words.end(), is_place_name)) {
    static_cast<void>(route.push_back(read_goal_order(text)));
    return route;
  }
  std::vector<std::string> names;
  for (const NamedPlace& place : places) names.push_back(place.name);
  for (const std::string& word : words) {
    const auto found = std::find_if(places.begin(), places.end(), [&](const NamedPlace& p) { return p.name == word; });
    if (found == places.end())
      throw StartupError(
          "goto: there is no place " + shown(word),
          did_you_mean(word, names,
                       names.empty() ? "name it in [[places]] of the robot file" : "there are " + joined(names)));
    if (!route.push_back(found->order))
      throw StartupError("goto: " + std::to_string(words.size()) + " places",
                         "give at most " + std::to_string(Route::capacity()));
  }
  return route;
}

std::string words_of(const GoalOrder& order) {
  std::array<char, 100> words{};
  const Vec2 p = order.position_in_map;
  const int length = std::snprintf(words.data(), words.size(), "%.17g %.17g", p.x, p.y);
  if (std::isnan(order.heading_rad)) return words.data();
  std::snprintf(words.data() + length, words.size() - static_cast<std::size_t>(length), " %.17g", order.heading_rad);
  return words.data();
}

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
