#pragma once
#include <cstddef>

#include "planner/field/executor.h"

namespace jaywalk::test {

/// The memory of an executor for tests that visits on the host: host and stages share it.
class OneMemory {
 public:
  static constexpr bool kQueue = false;
  static constexpr bool kOneMemory = true;

  template <class T>
  T* take(std::size_t n) {
    return memory_.take<T>(n);
  }
  template <class T>
  T* show(T* stages, std::size_t) {
    return stages;
  }
  template <class T>
  void fill(T* to, const T* from, std::size_t n) {
    memory_.fill(to, from, n);
  }
  [[nodiscard]] static double took_ms() noexcept { return 0.0; }

 private:
  field::SerialExecutor memory_;
};

}  // namespace jaywalk::test
