#pragma once
// Numbers in bytes, and bytes that wait to be read.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <type_traits>

namespace jaywalk::wire {

using Bytes = std::span<const std::uint8_t>;

[[nodiscard]] inline std::string_view text_of(Bytes bytes) noexcept {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// The unsigned integer that the first sizeof(T) bytes hold, least significant first; `bytes` has that many.
template <class T>
[[nodiscard]] T little_endian(Bytes bytes) noexcept {
  static_assert(std::is_unsigned_v<T>);
  T value = 0;
  for (std::size_t i = sizeof(T); i-- > 0;)
    value = static_cast<T>((static_cast<std::uint64_t>(value) << 8U) | bytes[i]);
  return value;
}

/// The same, most significant first.
template <class T>
[[nodiscard]] T big_endian(Bytes bytes) noexcept {
  static_assert(std::is_unsigned_v<T>);
  T value = 0;
  for (std::size_t i = 0; i < sizeof(T); ++i)
    value = static_cast<T>((static_cast<std::uint64_t>(value) << 8U) | bytes[i]);
  return value;
}

/// Writes `value` to the first sizeof(T) of `out`, least significant byte first.
template <class T>
void put_little_endian(T value, std::span<std::uint8_t> out) noexcept {
  static_assert(std::is_unsigned_v<T>);
  for (std::size_t i = 0; i < sizeof(T); ++i)
    out[i] = static_cast<std::uint8_t>(static_cast<std::uint64_t>(value) >> (8U * i));
}

/// The same, most significant byte first.
template <class T>
void put_big_endian(T value, std::span<std::uint8_t> out) noexcept {
  static_assert(std::is_unsigned_v<T>);
  for (std::size_t i = 0; i < sizeof(T); ++i)
    out[i] = static_cast<std::uint8_t>(static_cast<std::uint64_t>(value) >> (8U * (sizeof(T) - 1 - i)));
}

/// Cyclic redundancy check as wide as T, from 0, highest bit first.
template <class T>
[[nodiscard]] T crc_of(Bytes bytes, T polynomial) noexcept {
  constexpr unsigned kTop = 8 * sizeof(T) - 1;
  unsigned crc = 0;
  for (const std::uint8_t byte : bytes) {
    crc ^= static_cast<unsigned>(byte) << (kTop - 7);
    for (int bit = 0; bit < 8; ++bit) crc = (crc << 1U) ^ ((crc >> kTop & 1U) != 0 ? polynomial : 0U);
  }
  return static_cast<T>(crc);
}

/// Walks through bytes that may end anywhere: what is read beyond their end is 0, and ok() is false from then on.
/// So a decoder reads all its fields first and asks once.
class ByteReader {
 public:
  explicit ByteReader(Bytes bytes) noexcept : rest_(bytes) {}

  [[nodiscard]] bool ok() const noexcept { return ok_; }
  [[nodiscard]] Bytes rest() const noexcept { return rest_; }

  template <class T>
  T little() noexcept {
    const Bytes field = take(sizeof(T));
    return field.empty() ? T{0} : little_endian<T>(field);
  }
  template <class T>
  T big() noexcept {
    const Bytes field = take(sizeof(T));
    return field.empty() ? T{0} : big_endian<T>(field);
  }
  /// The next `count` bytes; empty, and ok() false, where there are fewer.
  Bytes take(std::size_t count) noexcept {
    if (count > rest_.size()) {
      ok_ = false;
      rest_ = {};
      return {};
    }
    const Bytes taken = rest_.first(count);
    rest_ = rest_.subspan(count);
    return taken;
  }

 private:
  Bytes rest_;
  bool ok_ = true;
};

/// Bytes of a stream that wait to be understood, in place. When new ones do not fit, the oldest are skipped: of a
/// sensor only the newest matters, and a reader that finds no beginning any more finds the next one.
template <std::size_t N>
class ByteQueue {
 public:
  void append(Bytes bytes) noexcept {
    if (bytes.size() > N) {
      skipped_ += bytes.size() - N;
      bytes = bytes.last(N);
    }
    if (size_ + bytes.size() > N) skip(size_ + bytes.size() - N);
    if (begin_ + size_ + bytes.size() > N) {
      std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(begin_), size_, bytes_.begin());
      begin_ = 0;
    }
    std::copy(bytes.begin(), bytes.end(), bytes_.begin() + static_cast<std::ptrdiff_t>(begin_ + size_));
    size_ += bytes.size();
  }
  /// Oldest first; valid until the next append.
  [[nodiscard]] Bytes waiting() const noexcept { return {bytes_.data() + begin_, size_}; }
  /// Forgets the oldest `count`, or all where there are fewer; spans of them stay valid until the next append.
  void drop(std::size_t count) noexcept {
    count = std::min(count, size_);
    begin_ += count;
    size_ -= count;
  }
  /// Forgets them as bytes that belong to no message.
  void skip(std::size_t count) noexcept {
    skipped_ += std::min(count, size_);
    drop(count);
  }
  /// Forgets all that waits, uncounted: another connection begins.
  void clear() noexcept { begin_ = size_ = 0; }
  /// Bytes that belonged to no message.
  [[nodiscard]] std::uint64_t skipped() const noexcept { return skipped_; }

 private:
  std::array<std::uint8_t, N> bytes_{};
  std::size_t begin_ = 0;
  std::size_t size_ = 0;
  std::uint64_t skipped_ = 0;
};

}  // namespace jaywalk::wire
