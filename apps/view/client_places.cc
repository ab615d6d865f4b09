#include "apps/view/client_places.h"

#include <algorithm>
#include <map>

namespace jaywalk::view {
namespace {

constexpr std::chrono::seconds kStuck{1};

}  // namespace

std::optional<std::size_t> gives_way(std::span<const Placed> placed, Stage stage, std::uint32_t address) {
  std::map<std::uint32_t, std::size_t> held;
  for (const Placed& one : placed) ++held[one.address];
  const auto stuck = [stage](const Placed& one) {
    return stage == Stage::kLooks && one.stuck >= kStuck ? one.stuck : Placed::Clock::duration{};
  };
  const auto is_worse = [&](const Placed& a, const Placed& b) {  // a goes rather than b
    if (a.is_served != b.is_served) return a.is_served;
    if (stuck(a) != stuck(b)) return stuck(a) > stuck(b);
    return held[a.address] != held[b.address] ? held[a.address] > held[b.address] : a.since < b.since;
  };
  const auto worst = std::min_element(placed.begin(), placed.end(), is_worse);
  if (worst == placed.end()) return std::nullopt;
  const bool must = stage != Stage::kLooks || stuck(*worst) >= kStuck || held[worst->address] >= held[address] + 2;
  if (!must) return std::nullopt;
  return static_cast<std::size_t>(worst - placed.begin());
}

}  // namespace jaywalk::view
