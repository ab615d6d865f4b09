#pragma once
// A robot has one scanner or more. What there is of each is kept as the first's and those of the others, in the order
// of the robot's file: most robots have one, and read as such.
#include <cstddef>
#include <span>

#include "hal/types/fixed_vector.h"

namespace jaywalk {

/// One at each corner.
inline constexpr std::size_t kMostScanners = 4;

template <class T>
using OfOthers = FixedVector<T, kMostScanners - 1>;

/// A view of what there is of each scanner. What it looks at outlives it.
template <class T>
class OfEach {
 public:
  OfEach(const T& first, std::span<const T> others = {}) noexcept : first_(&first), others_(others) {}
  /// `all`: one or more.
  explicit OfEach(std::span<const T> all) noexcept : OfEach(all.front(), all.subspan(1)) {}

  [[nodiscard]] std::size_t size() const noexcept { return 1 + others_.size(); }
  [[nodiscard]] const T& operator[](std::size_t scanner) const noexcept {
    return scanner == 0 ? *first_ : others_[scanner - 1];
  }

  class Iterator {
   public:
    Iterator(const OfEach& each, std::size_t at) noexcept : each_(&each), at_(at) {}
    const T& operator*() const noexcept { return (*each_)[at_]; }
    Iterator& operator++() noexcept { return ++at_, *this; }
    bool operator!=(const Iterator& other) const noexcept { return at_ != other.at_; }

   private:
    const OfEach* each_;
    std::size_t at_;
  };
  [[nodiscard]] Iterator begin() const noexcept { return {*this, 0}; }
  [[nodiscard]] Iterator end() const noexcept { return {*this, size()}; }

 private:
  const T* first_;
  std::span<const T> others_;
};

}  // namespace jaywalk
