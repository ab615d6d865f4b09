// How right the field is on maps that nobody has tuned it on: certificate, reach, cycles, and the share of cells that
// pick the exact field's best neighbour, worst and median, cold and warm.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "bench/field/random_maps.h"

using namespace jaywalk;

namespace {
/// No limit: whoever runs this has time.
constexpr double kAnyNumber = 1e300;
constexpr std::int32_t kLeastJoined = 500;  ///< a goal in a smaller pocket tells nothing

struct Shares {
  std::vector<double> values;
  [[nodiscard]] double worst() const { return values.empty() ? 1.0 : *std::min_element(values.begin(), values.end()); }
  [[nodiscard]] double median() {
    if (values.empty()) return 1.0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
  }
};

struct Tally {
  int maps = 0, certified = 0, arriving = 0, cycles = 0;
  Shares cold, warm;
};

void solve(MapKind kind, std::int32_t side, std::uint64_t seed, Tally& tally) {
  MapRandom random(7 * seed + static_cast<std::uint64_t>(kind));
  const auto field = paper::make_cpu_map_field(random_map(kind, side, random));
  field->inflate(static_cast<float>(random.below(5)));
  CellIndex goal{random.below(side), random.below(side)};
  if (!field->nearest_free(goal, side)) return;
  const paper::MapQuality cold = field->solve_cold(goal);
  if (cold.joined < kLeastJoined) return;
  ++tally.maps;
  tally.cycles += cold.cycles;
  bool arrives = field->reach(goal) == 1.0F;
  tally.cold.values.push_back(field->best_neighbours(goal, kAnyNumber).value());
  const paper::MapQuality warm = field->solve_warm(goal);
  arrives = arrives && field->reach(goal) == 1.0F;
  tally.warm.values.push_back(field->best_neighbours(goal, kAnyNumber).value());
  tally.certified += cold.certified && warm.certified ? 1 : 0;
  tally.arriving += arrives ? 1 : 0;
}

int number(const char* word, int least, int most) {
  char* end = nullptr;
  const long value = std::strtol(word, &end, 10);
  if (end == word || *end != '\0' || value < least || value > most) {
    std::fprintf(stderr, "jaywalk_field_bench: %s: not a number from %d to %d\n", word, least, most);
    std::exit(2);
  }
  return static_cast<int>(value);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr, "usage: jaywalk_field_bench SIDE FIRST_SEED LAST_SEED\n");
    return 2;
  }
  const int side = number(argv[1], 64, 512), first = number(argv[2], 0, 1000000), last = number(argv[3], 0, 1000000);
  std::printf("%-6s %5s %9s %8s %7s %10s %12s %10s %12s\n", "kind", "maps", "certified", "arriving", "cycles",
              "worst cold", "median cold", "worst warm", "median warm");
  for (const MapKind kind : kMapKinds) {
    Tally tally;
    for (int seed = first; seed <= last; ++seed) solve(kind, side, static_cast<std::uint64_t>(seed), tally);
    std::printf("%-6s %5d %9d %8d %7.2f %9.3f%% %11.3f%% %9.3f%% %11.3f%%\n", name_of(kind), tally.maps,
                tally.certified, tally.arriving, tally.cycles / std::max(1.0, static_cast<double>(tally.maps)),
                100.0 * tally.cold.worst(), 100.0 * tally.cold.median(), 100.0 * tally.warm.worst(),
                100.0 * tally.warm.median());
    std::fflush(stdout);
  }
  return 0;
}
