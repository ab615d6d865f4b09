#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <queue>
#include <utility>

#include "apps/bench/bench.h"
#include "apps/rivals/paper_mode.h"
#include "hal/types/errors.h"

namespace jaywalk {
namespace {

BenchMap walled(std::string name, std::int32_t side) {
  const auto n = static_cast<std::size_t>(side);
  BenchMap map{std::move(name), {side, side, std::vector<std::uint8_t>(n * n, 0)}, {12, 12}, {side - 12, 12}};
  for (std::size_t k = 0; k < n; ++k)
    map.cells.wall[k] = map.cells.wall[(n - 1) * n + k] = map.cells.wall[k * n] = map.cells.wall[k * n + n - 1] = 1;
  return map;
}

/// Cells [i0, i1) x [j0, j1), clipped to what lies inside the outer walls.
struct Cells {
  std::int32_t i0, j0, i1, j1;
};

void set(BenchMap& map, const Cells& cells, std::uint8_t value) {
  const std::int32_t side = map.cells.width;
  for (std::int32_t j = std::max(cells.j0, 1); j < std::min(cells.j1, side - 1); ++j) {
    for (std::int32_t i = std::max(cells.i0, 1); i < std::min(cells.i1, side - 1); ++i) {
      map.cells.wall[static_cast<std::size_t>(j) * static_cast<std::size_t>(side) + static_cast<std::size_t>(i)] =
          value;
    }
  }
}

/// Rooms of 5 m on both sides of corridors 3 m wide, doors 1.2 m.
BenchMap office(std::int32_t side) {
  BenchMap map = walled("office", side);
  constexpr std::int32_t kRoom = 50, kCorridor = 30, kDoor = 12, kPeriod = 2 * kRoom + kCorridor;
  for (std::int32_t j = kRoom; j < side; j += kPeriod)
    set(map, {0, j, side, j + 2}, 1), set(map, {0, j + kCorridor, side, j + kCorridor + 2}, 1);
  for (std::int32_t i = kRoom; i < side; i += kRoom) set(map, {i, 0, i + 2, side}, 1);
  for (std::int32_t j = kRoom; j < side; j += kPeriod) {
    set(map, {0, j + 2, side, j + kCorridor}, 0);
    for (std::int32_t i = 20; i < side; i += kRoom)
      set(map, {i, j, i + kDoor, j + 2}, 0), set(map, {i, j + kCorridor, i + kDoor, j + kCorridor + 2}, 0);
    // One door between rooms that lie back to back, so that corridors are joined.
    set(map, {20, j + kCorridor + kRoom - 6, 32, j + kCorridor + kRoom + 6}, 0);
  }
  return map;
}

BenchMap serpentine(std::int32_t side, std::int32_t corridor) {
  BenchMap map = walled(corridor == 15 ? "corridor 1.5 m" : "corridor 1.0 m", side);
  bool right = true;
  for (std::int32_t j = 1 + corridor; j + corridor < side - 1; j += corridor + 2, right = !right)
    set(map, {right ? 0 : 1 + corridor, j, right ? side - 1 - corridor : side, j + 2}, 1);
  map.goal = {12, 5};
  map.start = {side - 12, 5};
  return map;
}

BenchMap clutter(std::int32_t side) {
  BenchMap map = walled("clutter", side);
  std::uint32_t state = 12345;
  const auto below = [&state](std::int32_t n) {  // Numerical Recipes' congruential generator, high bits
    state = state * 1664525U + 1013904223U;
    return static_cast<std::int32_t>((state >> 8) % static_cast<std::uint32_t>(n));
  };
  for (std::int32_t k = 0; k < side * side / 600; ++k) {
    const std::int32_t i = 1 + below(side), j = 1 + below(side);
    const std::int32_t w = 2 + below(9), h = 2 + below(9);
    set(map, {i, j, i + w, j + h}, 1);
  }
  set(map, {4, 4, 24, 24}, 0);
  return map;
}

constexpr std::int32_t kNoWay = -1;
constexpr std::int32_t kStraight = 10, kDiagonal = 14;

/// Shortest ways and harmonic potentials as textbooks have them, on a map's free cells.
class BenchRivals {
 public:
  /// Takes all memory.
  explicit BenchRivals(const BenchMap& map)
      : side_(map.cells.width), stride_(static_cast<std::size_t>(side_) + 2), goal_(index(map.goal)) {
    const auto field = paper::make_cpu_map_field(map.cells);
    field->inflate(kBenchInflation);
    (void)field->solve_start(map.goal);
    for (std::int32_t j = 0; j < side_; ++j)
      for (std::int32_t i = 0; i < side_; ++i) free_[index({i, j})] = std::isnan(field->psi(i, j)) ? 0 : 1;
  }

  /// Steps to the goal over four neighbours, breadth first.
  void wavefront() {
    std::fill(distance_.begin(), distance_.end(), kNoWay);
    const auto stride = static_cast<std::uint32_t>(stride_);
    std::size_t head = 0, tail = 0;
    queue_[tail++] = static_cast<std::uint32_t>(goal_);
    distance_[goal_] = 0;
    while (head < tail) {
      const std::uint32_t c = queue_[head++];
      for (const std::uint32_t n : {c + 1, c - 1, c + stride, c - stride}) {
        if (free_[n] == 0 || distance_[n] != kNoWay) continue;
        distance_[n] = distance_[c] + 1;
        queue_[tail++] = n;
      }
    }
  }

  /// Distance to the goal over eight neighbours (10 straight, 14 diagonal), by a ring of buckets.
  void dijkstra_buckets() {
    std::fill(distance_.begin(), distance_.end(), kNoWay);
    std::array<std::vector<std::uint32_t>, 16> ring;  // more than the dearest step
    distance_[goal_] = 0;
    ring[0].push_back(static_cast<std::uint32_t>(goal_));
    std::size_t queued = 1;
    for (std::int32_t reached = 0; queued > 0; ++reached) {
      std::vector<std::uint32_t>& bucket = ring[static_cast<std::size_t>(reached % 16)];
      for (const std::uint32_t c : bucket) {
        if (distance_[c] != reached) continue;  // found a shorter way meanwhile
        go_on(c, [&](std::int32_t through, std::uint32_t n) {
          ring[static_cast<std::size_t>(through % 16)].push_back(n);
          ++queued;
        });
      }
      queued -= bucket.size();
      bucket.clear();
    }
  }

  /// The same by a binary heap.
  void dijkstra_heap() {
    using Entry = std::pair<std::int32_t, std::uint32_t>;
    std::fill(distance_.begin(), distance_.end(), kNoWay);
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> heap;
    distance_[goal_] = 0;
    heap.emplace(0, static_cast<std::uint32_t>(goal_));
    while (!heap.empty()) {
      const auto [reached, c] = heap.top();
      heap.pop();
      if (distance_[c] == reached) go_on(c, [&](std::int32_t through, std::uint32_t n) { heap.emplace(through, n); });
    }
  }

  /// The paper's recipe: 100 red-black sweeps of the harmonic potential from 0.5, single precision.
  void hundred_sweeps() {
    for (std::size_t c = 0; c < phi_.size(); ++c) phi_[c] = free_[c] != 0 ? 0.5F : 1.0F;
    phi_[goal_] = 0.0F;
    for (std::int32_t half = 0; half < 200; ++half) {
      for (std::int32_t j = 0; j < side_; ++j) {
        for (std::int32_t i = (j + 1 + half) & 1; i < side_; i += 2) {
          const std::size_t c = index({i, j});
          if (free_[c] == 0 || c == goal_) continue;
          phi_[c] = 0.25F * ((phi_[c + 1] + phi_[c - 1]) + (phi_[c + stride_] + phi_[c - stride_]));
        }
      }
    }
  }

 private:
  [[nodiscard]] std::size_t index(CellIndex at) const {
    return static_cast<std::size_t>(at.j + 1) * stride_ + static_cast<std::size_t>(at.i + 1);
  }
  /// Offers the way through `from` to each of its eight neighbours that is free, corners not cut: push(distance, cell)
  /// for those that it is shorter for.
  template <class Push>
  void go_on(std::size_t from, const Push& push) {
    const std::size_t east = from + 1, west = from - 1, north = from + stride_, south = from - stride_;
    const auto offer = [&, reached = distance_[from]](std::size_t n, std::int32_t cost) {
      const std::int32_t through = reached + cost;
      if (distance_[n] != kNoWay && distance_[n] <= through) return;
      distance_[n] = through;
      push(through, static_cast<std::uint32_t>(n));
    };
    for (const std::size_t n : {east, west, north, south})
      if (free_[n] != 0) offer(n, kStraight);
    const auto corner = [&](std::size_t n, std::size_t a, std::size_t b) {
      if (free_[n] != 0 && free_[a] != 0 && free_[b] != 0) offer(n, kDiagonal);
    };
    corner(north + 1, north, east), corner(north - 1, north, west);
    corner(south + 1, south, east), corner(south - 1, south, west);
  }

  std::int32_t side_;
  std::size_t stride_, goal_;  ///< a ring of cells round the map is not free
  std::vector<std::uint8_t> free_ = std::vector<std::uint8_t>(stride_ * stride_, 0);
  std::vector<std::int32_t> distance_ = std::vector<std::int32_t>(free_.size());
  std::vector<std::uint32_t> queue_ = std::vector<std::uint32_t>(free_.size());
  std::vector<float> phi_ = std::vector<float>(free_.size());
};

}  // namespace

std::vector<BenchMap> bench_maps(std::int32_t side) {
  return {walled("open", side), office(side), serpentine(side, 15), serpentine(side, 10), clutter(side)};
}

BenchMap scaled_map(const std::filesystem::path& file, std::int32_t side) {
  const MapCells coarse = load_map_cells(file, std::nullopt);
  const double extent = std::max(coarse.cells.width, coarse.cells.height) * coarse.cell_m;
  const MapCells fine = load_map_cells(file, extent / (side - 4));
  const auto n = static_cast<std::size_t>(side);
  BenchMap map{file.stem().string(), {side, side, std::vector<std::uint8_t>(n * n, 1)}, {}, {}};
  for (std::int32_t j = 0; j < fine.cells.height; ++j) {
    const auto row = fine.cells.wall.begin() + static_cast<std::ptrdiff_t>(j) * fine.cells.width;
    std::copy(row, row + fine.cells.width, map.cells.wall.begin() + static_cast<std::ptrdiff_t>(j) * side);
  }
  const auto field = paper::make_cpu_map_field(map.cells);
  field->inflate(kBenchInflation);
  map.goal = {fine.cells.width / 2, fine.cells.height / 2};
  map.start = {fine.cells.width - 12, fine.cells.height - 12};
  if (!field->nearest_free(map.goal, side) || !field->nearest_free(map.start, side))
    throw StartupError(file.string() + ": no free cell", "give a map with room for a robot");
  return map;
}

EvidenceMap evidence_of(const BenchMap& map, int of_free) {
  const std::int32_t side = map.cells.width;
  const double middle_m = 0.5 * side * kBenchCell_m;
  EvidenceMap evidence(2 * side, kBenchCell_m, {middle_m, middle_m});
  for (std::int32_t j = 0; j < side; ++j) {
    for (std::int32_t i = 0; i < side; ++i) {
      const bool wall = map.cells.wall[static_cast<std::size_t>(j * side + i)] != 0;
      evidence.add({i, j}, wall ? EvidenceMap::kMax : of_free);
    }
  }
  return evidence;
}

Track walker_at(std::size_t number, Vec2 place, Vec2 velocity) {
  Track track;
  track.id = static_cast<std::uint32_t>(number + 1);
  track.position_in_map = place;
  track.velocity_in_map = velocity;
  track.covariance = {0.001, 0.0, 0.002};
  track.radius_m = 0.27;
  return track;
}

std::vector<Timing> time_rivals(const BenchMap& map, int repeats) {
  BenchRivals rivals(map);
  return {time("wavefront", repeats, "cpu", [&] { rivals.wavefront(); }),
          time("dijkstra, buckets", repeats, "cpu", [&] { rivals.dijkstra_buckets(); }),
          time("dijkstra, heap", repeats, "cpu", [&] { rivals.dijkstra_heap(); }),
          time("100 sweeps", repeats, "cpu", [&] { rivals.hundred_sweeps(); })};
}

}  // namespace jaywalk
