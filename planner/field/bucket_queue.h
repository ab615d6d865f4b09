#pragma once
#include <cstddef>
#include <vector>

#include "planner/field/cost_repair.h"
#include "planner/field/start_field.h"

namespace jaywalk::field {

/// The start field's fixed point by a queue of buckets, Dial's, with costs within a bucket in any order: what one
/// thread does best. A cell that improves is queued again and its old entry passed over. All that is known of a cell
/// lies together, with a ring of cells round the grid that are not free, so that a step is one fetch and no question.
/// Where few rates have changed since the last time, what depends on them is repaired, to the same bytes.
class BucketQueue {
 public:
  /// Takes memory for grids up to `max_side` cells, and for `entries` cells in the queue. Where that is too few,
  /// settle() falls back to sweeps over all cells, which take long.
  BucketQueue(std::int32_t max_side, std::size_t entries);
  /// Fills `cost`: 0 at the goal, a free cell; kNoWay where there is no way or the rate is 0.
  void settle(Grid grid, std::int32_t goal, const std::uint16_t* rate, std::uint32_t* cost) noexcept;

 private:
  static constexpr std::uint32_t kBucketShift = 7;  ///< 128 costs a bucket
  static constexpr std::uint32_t kBuckets = kDearestStep >> kBucketShift;
  static constexpr std::size_t kChunk = 63;  ///< entries: 256 bytes with the link

  struct Node {
    std::uint32_t cost, rate;
  };
  struct Chunk {
    std::int32_t next;
    std::int32_t cells[kChunk];
  };
  /// A list of chunks, all full but the last.
  struct Bucket {
    std::int32_t first, last;
    std::size_t filled;  ///< entries of the last
  };

  struct Ways;

  [[nodiscard]] bool repair(Grid grid, std::int32_t goal, const std::uint16_t* rate) noexcept;
  void settle_anew(Grid grid, std::int32_t goal, const std::uint16_t* rate) noexcept;
  void settle_in_turn(const Ways& ways) noexcept;
  [[nodiscard]] static std::int32_t place(Grid grid, std::int32_t c) noexcept;
  void load(Grid grid, const std::uint16_t* rate) noexcept;
  void relax(std::int32_t to, std::int32_t width, std::uint32_t through, std::uint32_t bucket) noexcept;
  void push(std::int32_t n, std::int32_t width, std::uint32_t bucket) noexcept;
  void drain(std::int32_t width, std::uint32_t bucket) noexcept;
  void step_from(std::int32_t n, std::int32_t width, std::uint32_t bucket) noexcept;

  std::vector<Node> nodes_;
  std::vector<Chunk> chunks_;
  std::int32_t spare_ = 0;  ///< first chunk that nobody uses
  Bucket buckets_[kBuckets];
  std::size_t chunks_in_use_ = 0;
  bool full_ = false;
  Grid settled_grid_;               ///< whose costs the nodes hold; side 0: none
  std::int32_t settled_goal_ = -1;  ///< to which cell
  int not_tried_ = 0;               ///< repairs, from now on
  std::vector<std::int32_t> changed_;
  CostRepair repair_;
};

}  // namespace jaywalk::field
