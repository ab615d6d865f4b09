#include "cuda/emulated/launch.h"

#include <algorithm>
#include <cstdio>
#include <numeric>
#include <utility>

#include "cuda/emulated/poison.h"

namespace jaywalk::emulated {

void Launch::begin(std::size_t blocks) {
  warps_.assign(blocks * warps_of_block(), {});
  for (std::size_t k = 0; k < warps_.size(); ++k) {
    const std::size_t first = k % warps_of_block() * kWarp;
    warps_[k].expected = threads_ - first < kWarp ? threads_ - first : kWarp;
  }
  blocks_.assign(blocks, {threads_, {}});
  clusters_.assign(blocks / shape_->cluster_blocks, {threads_ * shape_->cluster_blocks, {}});
  // Blocks that were not launched to meet never do.
  grid_ = {shape_->cooperative ? threads_ * blocks : threads_ * shape_->grid.count() + 1, {}};
  ready_.assign(blocks, {});
  for (std::size_t k = 0; k < blocks * threads_; ++k) ready_[k / threads_].push_back(static_cast<std::uint32_t>(k));
  lane_values_.assign(warps_.size() * kWarp, 0);
  votes_.assign(blocks, false), found_.assign(blocks, false);
  ended_ = 0;
  special_ = 0;
  fibers_.make(
      blocks * threads_, [](void* launch) { (*static_cast<Launch*>(launch)->kernel_)(); }, this);
}

Ended Launch::run_blocks(std::size_t blocks, OrderRandom& random, std::int64_t limit) {
  begin(blocks);
  if (may_meet()) shared_.begin(blocks, shape_->dynamic_bytes);
  if (!may_meet()) poison(block_memory, shape_->dynamic_bytes);
  Ended how = Ended::kWell;
  while (ended_ < blocks * threads_ && how == Ended::kWell) {
    choose(random);
    for (const std::uint32_t thread : chosen_) resume(thread);
    if (chosen_.empty()) how = Ended::kNever;
    if (counts_->grid + counts_->cluster + counts_->block > limit) how = Ended::kTooLong;
  }
  if (may_meet()) shared_.end();
  if (how == Ended::kNever) {
    std::size_t at_blocks = 0, at_clusters = 0;
    for (const Barrier& barrier : blocks_) at_blocks += barrier.waiting.size();
    for (const Barrier& barrier : clusters_) at_clusters += barrier.waiting.size();
    std::fprintf(stderr,
                 "emulated CUDA: of %zu threads %zu have ended, %zu wait for their block, %zu for their cluster, %zu "
                 "for the grid\n",
                 blocks * threads_, ended_, at_blocks, at_clusters, grid_.waiting.size());
  }
  return fibers_.are_stacks_whole() ? how : Ended::kOffStack;
}

Ended Launch::run(const Shape& shape, const std::function<void()>& kernel, OrderRandom& random,
                  std::int64_t most_barriers, Counts& counts) {
  shape_ = &shape, kernel_ = &kernel, counts_ = &counts;
  threads_ = shape.block.count();
  here.block_extent = shape.block, here.grid_extent = shape.grid;
  Launch* before = std::exchange(launch_under_way, this);
  const std::int64_t limit = counts.grid + counts.cluster + counts.block + most_barriers;
  std::vector<std::size_t> order(may_meet() ? 1 : shape.grid.count());
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (std::size_t k = order.size(); k > 1; --k) std::swap(order[k - 1], order[random.below(k)]);
  Ended how = Ended::kWell;
  for (const std::size_t block : order) {
    first_ = block;
    if (how == Ended::kWell) how = run_blocks(may_meet() ? shape.grid.count() : 1, random, limit);
  }
  launch_under_way = before;
  ++counts.launches;
  return how;
}

void Launch::choose(OrderRandom& random) {
  if (random.below(32) == 0) {
    habit_ = static_cast<Habit>(random.below(4));
    special_ = random.below(2) == 0 ? 0 : random.below(ready_.size());
    special_warp_ = random.below(warps_of_block());
  }
  std::vector<std::size_t> blocks;
  for (std::size_t k = 0; k < ready_.size(); ++k) {
    if (!ready_[k].empty()) blocks.push_back(k);
  }
  chosen_.clear();
  if (blocks.empty()) return;
  // To put large shared memories by takes long: block by block then.
  const std::uint32_t way = shared_.is_large() ? 0 : random.below(4);
  std::size_t one = blocks[random.below(blocks.size())];
  const bool only_special = habit_ == Habit::kAhead && !ready_[special_].empty();
  if (only_special) one = special_;
  const bool spare_special = habit_ == Habit::kBehind && blocks.size() > 1;
  if (spare_special && one == special_) one = blocks[blocks[0] == special_ ? 1 : 0];
  for (const std::size_t k : blocks) {
    const bool left_out =
        way < 2 || only_special || (way == 2 && random.below(2) == 0) || (spare_special && k == special_);
    if (k != one && left_out) continue;
    take(ready_[k]);
  }
  for (std::size_t k = chosen_.size(); k > 1; --k) std::swap(chosen_[k - 1], chosen_[random.below(k)]);
}

void Launch::take(std::vector<std::uint32_t>& ready) {
  const auto is_ahead = [this](std::uint32_t thread) { return thread % threads_ / kWarp == special_warp_; };
  auto last = ready.begin();
  if (habit_ == Habit::kWarpAhead) last = std::stable_partition(ready.begin(), ready.end(), is_ahead);
  if (last == ready.begin()) last = ready.end();
  chosen_.insert(chosen_.end(), ready.begin(), last);
  ready.erase(ready.begin(), last);
}

void Launch::resume(std::uint32_t thread) {
  running_ = thread;
  if (may_meet()) shared_.enter(block());
  here.thread = shape_->block.place(this->thread());
  here.block = shape_->grid.place(block());
  if (!fibers_.resume(thread)) ++ended_;
}

void Launch::meet(Barrier& barrier, std::int64_t& count) {
  barrier.waiting.push_back(static_cast<std::uint32_t>(running_));
  if (barrier.waiting.size() == barrier.expected) {
    ++count;
    for (const std::uint32_t thread : barrier.waiting) ready_[thread / threads_].push_back(thread);
    barrier.waiting.clear();
  }
  fibers_.give_way();
}

/// The last one to come counts: what it found stays until all have come again, and so have read it.
bool Launch::any_of_block(bool vote) {
  const std::size_t k = running_ / threads_;
  votes_[k] = votes_[k] || vote;
  if (blocks_[k].waiting.size() + 1 == blocks_[k].expected) found_[k] = votes_[k], votes_[k] = false;
  meet_block();
  return found_[k];
}

void Launch::meet_warp() { meet(warps_[warp()], counts_->warp); }
void Launch::meet_block() { meet(blocks_[running_ / threads_], counts_->block); }
void Launch::meet_cluster() { meet(clusters_[running_ / threads_ / shape_->cluster_blocks], counts_->cluster); }
void Launch::meet_grid() { meet(grid_, counts_->grid); }

void Launch::pause() {
  ready_[running_ / threads_].push_back(static_cast<std::uint32_t>(running_));
  fibers_.give_way();
}

}  // namespace jaywalk::emulated
