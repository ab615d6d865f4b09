#pragma once
#include <array>
#include <cstddef>

namespace jaywalk {

/// A vector in place with a fixed capacity: it never allocates. T is default-constructible and trivially copyable.
template <class T, std::size_t N>
class FixedVector {
 public:
  static constexpr std::size_t capacity() { return N; }
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  [[nodiscard]] bool full() const { return size_ == N; }
  void clear() { size_ = 0; }

  /// False, and nothing changed, when full.
  [[nodiscard]] bool push_back(const T& value) {
    if (full()) return false;
    items_[size_++] = value;
    return true;
  }
  /// Removes item `i` by moving the last into its place; order is not kept.
  void swap_remove(std::size_t i) { items_[i] = items_[--size_]; }
  /// Keeps the first `n` items, n <= size().
  void truncate(std::size_t n) { size_ = n; }

  T& operator[](std::size_t i) { return items_[i]; }
  const T& operator[](std::size_t i) const { return items_[i]; }
  T& back() { return items_[size_ - 1]; }
  const T& back() const { return items_[size_ - 1]; }
  T* begin() { return items_.data(); }
  T* end() { return items_.data() + size_; }
  const T* begin() const { return items_.data(); }
  const T* end() const { return items_.data() + size_; }
  T* data() { return items_.data(); }
  const T* data() const { return items_.data(); }

 private:
  std::array<T, N> items_{};
  std::size_t size_ = 0;
};

}  // namespace jaywalk
