#pragma once
// What a user would pick instead, written plainly: each on the free cells alone, inflated beforehand at no cost.
#include <cstdint>
#include <vector>

#include "planner/mapping/evidence_map.h"

namespace jaywalk {

class BenchRivals {
 public:
  /// `free`: width x height, 1 where a robot may be. Takes all memory.
  BenchRivals(std::int32_t width, std::int32_t height, std::vector<std::uint8_t> free);

  /// Steps to the goal over four neighbours, breadth first.
  void wavefront(CellIndex goal);
  /// Distance to the goal over eight neighbours (10 straight, 14 diagonal), by a ring of buckets.
  void dijkstra_buckets(CellIndex goal);
  /// The same by a binary heap.
  void dijkstra_heap(CellIndex goal);
  /// The paper's recipe: 100 red-black sweeps of the harmonic potential from 0.5, single precision.
  void hundred_sweeps(CellIndex goal);

  /// Distance of a cell as the last of the first three methods found it; negative where there is no way.
  [[nodiscard]] std::int32_t distance(CellIndex at) const { return distance_[index(at)]; }

 private:
  [[nodiscard]] std::size_t index(CellIndex at) const {
    return static_cast<std::size_t>(at.j) * static_cast<std::size_t>(stride_) + static_cast<std::size_t>(at.i);
  }
  /// Calls visit(cell, cost) for each of the eight neighbours that is free, corners not cut.
  template <class Visit>
  void for_each_step(std::size_t from, const Visit& visit) const;

  std::int32_t width_, height_, stride_;  ///< a ring of cells round the map is not free
  std::vector<std::uint8_t> free_;
  std::vector<std::int32_t> distance_;
  std::vector<std::uint32_t> queue_;
  std::vector<float> phi_;
};

}  // namespace jaywalk
