#pragma once
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>

namespace jaywalk::wire {

using Bytes = std::span<const std::uint8_t>;

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
  for (std::size_t i = 0; i < sizeof(T); ++i) {
    value = static_cast<T>((static_cast<std::uint64_t>(value) << 8U) | bytes[i]);
  }
  return value;
}

/// Writes `value` to the first sizeof(T) of `out`, least significant byte first.
template <class T>
void put_little_endian(T value, std::span<std::uint8_t> out) noexcept {
  static_assert(std::is_unsigned_v<T>);
  for (std::size_t i = 0; i < sizeof(T); ++i) {
    out[i] = static_cast<std::uint8_t>(static_cast<std::uint64_t>(value) >> (8U * i));
  }
}

/// The same, most significant byte first.
template <class T>
void put_big_endian(T value, std::span<std::uint8_t> out) noexcept {
  static_assert(std::is_unsigned_v<T>);
  for (std::size_t i = 0; i < sizeof(T); ++i) {
    out[i] = static_cast<std::uint8_t>(static_cast<std::uint64_t>(value) >> (8U * (sizeof(T) - 1 - i)));
  }
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

}  // namespace jaywalk::wire
