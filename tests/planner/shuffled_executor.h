#pragma once
// Visits cells in random order, another one each time.
#include <numeric>
#include <utility>

#include "planner/field/executor.h"
#include "tests/planner/one_memory.h"
#include "tests/planner/test_maps.h"

namespace jaywalk::test {

class ShuffledExecutor : public OneMemory {
 public:
  template <class Order>
  void in_one_block(const Order& order) {
    order(*this);
  }

  template <class Stage>
  void for_each(std::int32_t n, const Stage& stage) {
    shuffle(n);
    for (const std::int32_t k : order_) stage(k);
  }

  template <class Stage>
  void for_each_cell(std::int32_t w, std::int32_t h, const Stage& stage) {
    shuffle(w * h);
    for (const std::int32_t k : order_) stage(k % w, k / w);
  }

  template <class... Steps>
  void for_each_row(std::int32_t h, const Steps&... steps) {
    (for_each_cell(steps.width, h / steps.every, steps.stage), ...);
  }

  template <class... Steps>
  void repeat(std::int32_t n, std::int32_t h, const Steps&... steps) {
    for (std::int32_t k = 0; k < n; ++k) for_each_row(h, steps...);
  }

  [[nodiscard]] const char* name() const noexcept { return "shuffled"; }

 private:
  void shuffle(std::int32_t n) {
    order_.resize(n < 0 ? 0U : static_cast<std::size_t>(n));
    std::iota(order_.begin(), order_.end(), 0);
    for (std::size_t k = order_.size(); k > 1; --k) {
      std::swap(order_[k - 1], order_[static_cast<std::size_t>(random_.below(static_cast<std::int32_t>(k)))]);
    }
  }

  Random random_{99};
  std::vector<std::int32_t> order_;
};

}  // namespace jaywalk::test
