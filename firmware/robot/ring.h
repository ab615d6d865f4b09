#pragma once
#include <array>
#include <atomic>
#include <cstddef>
#include <memory>

namespace jaywalk {

/// Hands every T from one writing thread to one reading thread, in order; neither ever waits. Memory is taken in the
/// constructor. A full ring takes no more, and the writer is told.
template <class T, std::size_t N>
class Ring {
 public:
  /// Writer's thread: the slot to fill; null when full.
  [[nodiscard]] T* draft() noexcept {
    const std::size_t next = written_.load(std::memory_order_relaxed);
    if (next - read_.load(std::memory_order_acquire) == N) return nullptr;
    return &(*slots_)[next % N];
  }
  /// Writer's thread: the draft is complete.
  void publish() noexcept { written_.fetch_add(1, std::memory_order_release); }
  /// Reader's thread: the oldest; null when there is none. Valid until pop().
  [[nodiscard]] const T* front() const noexcept {
    const std::size_t next = read_.load(std::memory_order_relaxed);
    if (next == written_.load(std::memory_order_acquire)) return nullptr;
    return &(*slots_)[next % N];
  }
  void pop() noexcept { read_.fetch_add(1, std::memory_order_release); }

 private:
  std::unique_ptr<std::array<T, N>> slots_ = std::make_unique<std::array<T, N>>();
  std::atomic<std::size_t> written_{0};
  std::atomic<std::size_t> read_{0};
};

}  // namespace jaywalk
