#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "drivers/wire/byte_reader.h"

namespace jaywalk::wire {

/// Bytes of a stream that wait to be understood, in place. When new ones do not fit, the oldest go and are counted:
/// of a sensor only the newest matters, and a reader that finds no beginning any more finds the next one.
template <std::size_t N>
class ByteQueue {
 public:
  void append(Bytes bytes) noexcept {
    if (bytes.size() > N) {
      lost_ += bytes.size() - N;
      bytes = bytes.last(N);
    }
    if (size_ + bytes.size() > N) {
      lost_ += size_ + bytes.size() - N;
      drop(size_ + bytes.size() - N);
    }
    if (begin_ + size_ + bytes.size() > N) {
      std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(begin_), size_, bytes_.begin());
      begin_ = 0;
    }
    std::copy(bytes.begin(), bytes.end(), bytes_.begin() + static_cast<std::ptrdiff_t>(begin_ + size_));
    size_ += bytes.size();
  }
  /// Oldest first; valid until the next append.
  [[nodiscard]] Bytes waiting() const noexcept { return {bytes_.data() + begin_, size_}; }
  /// Forgets the oldest `count`, or all where there are fewer.
  void drop(std::size_t count) noexcept {
    count = std::min(count, size_);
    begin_ += count;
    size_ -= count;
  }
  /// Forgets all that waits; what was lost stays counted.
  void clear() noexcept { begin_ = size_ = 0; }
  [[nodiscard]] std::uint64_t lost() const noexcept { return lost_; }

 private:
  std::array<std::uint8_t, N> bytes_{};
  std::size_t begin_ = 0;
  std::size_t size_ = 0;
  std::uint64_t lost_ = 0;
};

}  // namespace jaywalk::wire
