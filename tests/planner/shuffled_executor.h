#pragma once
// Visits cells in random order, another one each time.
#include <numeric>
#include <utility>

#include "planner/paper/executor.h"
#include "tests/planner/test_maps.h"

namespace jaywalk::test {

class ShuffledExecutor : public paper::SerialExecutor {
 public:
  template <class Stage>
  void for_each_cell(std::int32_t w, std::int32_t h, const Stage& stage) {
    order_.resize(static_cast<std::size_t>(w * h));
    std::iota(order_.begin(), order_.end(), 0);
    for (std::size_t k = order_.size(); k > 1; --k) {
      std::swap(order_[k - 1], order_[static_cast<std::size_t>(random_.below(static_cast<std::int32_t>(k)))]);
    }
    for (const std::int32_t k : order_) {
      if constexpr (requires { stage(k, k); }) {
        stage(k % w, k / w);
      } else {
        stage(k);
      }
    }
  }
  [[nodiscard]] const char* name() const noexcept { return "shuffled"; }

 private:
  Random random_{99};
  std::vector<std::int32_t> order_;
};

}  // namespace jaywalk::test
