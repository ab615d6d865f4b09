#include "cuda/emulated/launch.h"

#include <algorithm>
#include <cstdio>
#include <numeric>
#include <utility>

namespace jaywalk::emulated {

void Launch::begin_block(std::size_t block) {
  here.block = shape_->grid.place(block);
  ready_.resize(threads_);
  std::iota(ready_.begin(), ready_.end(), 0U);
  waiting_.clear();
  vote_ = false;
  ended_ = 0;
  fibers_.make(
      threads_, [](void* launch) { (*static_cast<Launch*>(launch)->kernel_)(); }, this);
}

Ended Launch::run_block(OrderRandom& random, std::int64_t limit) {
  while (ended_ < threads_) {
    choose(random);
    if (chosen_.empty()) {
      std::fprintf(stderr, "emulated CUDA: of %zu threads %zu have ended, %zu wait for their block\n", threads_, ended_,
                   waiting_.size());
      return Ended::kNever;
    }
    for (const std::uint32_t thread : chosen_) {
      running_ = thread;
      here.thread = shape_->block.place(thread);
      if (!fibers_.resume(thread)) ++ended_;
    }
    if (counts_->block > limit) return Ended::kTooLong;
  }
  return fibers_.are_stacks_whole() ? Ended::kWell : Ended::kOffStack;
}

Ended Launch::run(const Shape& shape, const std::function<void()>& kernel, OrderRandom& random,
                  std::int64_t most_barriers, Counts& counts) {
  shape_ = &shape, kernel_ = &kernel, counts_ = &counts;
  threads_ = shape.block.count();
  here.block_extent = shape.block, here.grid_extent = shape.grid;
  Launch* before = std::exchange(launch_under_way, this);
  std::vector<std::size_t> blocks(shape.grid.count());
  std::iota(blocks.begin(), blocks.end(), std::size_t{0});
  for (std::size_t k = blocks.size(); k > 1; --k) std::swap(blocks[k - 1], blocks[random.below(k)]);
  Ended how = Ended::kWell;
  for (std::size_t k = 0; k < blocks.size() && how == Ended::kWell; ++k) {
    begin_block(blocks[k]);
    how = run_block(random, counts.block + most_barriers);
  }
  launch_under_way = before;
  ++counts.launches;
  return how;
}

void Launch::choose(OrderRandom& random) {
  if (random.below(32) == 0) {
    is_warp_ahead_ = random.below(2) == 0;
    special_warp_ = random.below((threads_ + kWarp - 1) / kWarp);
  }
  auto last = ready_.end();
  if (is_warp_ahead_) {
    last = std::stable_partition(ready_.begin(), ready_.end(),
                                 [this](std::uint32_t thread) { return thread / kWarp == special_warp_; });
    if (last == ready_.begin()) last = ready_.end();
  }
  chosen_.assign(ready_.begin(), last);
  ready_.erase(ready_.begin(), last);
  for (std::size_t k = chosen_.size(); k > 1; --k) std::swap(chosen_[k - 1], chosen_[random.below(k)]);
}

void Launch::meet_block() {
  waiting_.push_back(static_cast<std::uint32_t>(running_));
  if (waiting_.size() == threads_) {
    ++counts_->block;
    ready_.swap(waiting_);
    waiting_.clear();
  }
  fibers_.give_way();
}

/// The last one to come counts: what it found stays until all have come again, and so have read it.
bool Launch::any_of_block(bool vote) {
  vote_ = vote_ || vote;
  if (waiting_.size() + 1 == threads_) found_ = std::exchange(vote_, false);
  meet_block();
  return found_;
}

}  // namespace jaywalk::emulated
