#pragma once
// One tick's record as bytes: the fields in the order of tick_entry.cc, little endian, without
// padding. A scan and a fix are written only where their sequence is new; only beams in use count. What a robot of
// several scanners has beyond that stands at the end: of one scanner there is nothing.
#include <array>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

#include "drivers/wire/byte_reader.h"
#include "firmware/recording/tick_record.h"

namespace jaywalk {

/// Of the fields and their order; no other version is read.
inline constexpr std::uint32_t kRecordingVersion = 7;

/// Most bytes that an encoded record takes: every beam, mover and point of a path in use (the change of a step between
/// places of 32 bits has 34), and room for the rest.
inline constexpr std::size_t kMaxEntryBytes =
    4 * kMaxBeams * kMostScanners + 40 * kMaxObservedMovers + 10 * kMaxPathPoints + 1024;

/// Turns records into bytes; remembers which scan and fix it wrote last. Never allocates or throws.
class TickEncoder {
 public:
  /// Bytes written to the front of `out`, which holds kMaxEntryBytes. `lost_before`: records that
  /// were dropped since the previous one.
  std::size_t encode(const TickRecord& record, std::uint64_t lost_before, std::span<unsigned char> out) noexcept;

 private:
  bool first_ = true;
  std::uint32_t scan_sequence_ = 0, fix_sequence_ = 0;
  std::array<std::uint32_t, kMostScanners - 1> others_{};  ///< sequences of the other scanners' scans
};

/// Turns bytes back into records; keeps the last scan and fix for those that bring none.
class TickDecoder {
 public:
  /// False when the bytes are no record: too few, too many, or a value out of its range.
  [[nodiscard]] bool decode(std::span<const unsigned char> in, TickRecord& record, std::uint64_t& lost_before) noexcept;

 private:
  LaserScan scan_;
  OfOthers<LaserScan> others_;
  OutsideFix fix_;
};

// Values as little-endian bytes, whatever the machine; floating point as its bits, NaN payloads and all.

template <std::size_t Size>
using UnsignedOfSize = std::conditional_t<
    Size == 1, std::uint8_t,
    std::conditional_t<Size == 2, std::uint16_t, std::conditional_t<Size == 4, std::uint32_t, std::uint64_t>>>;

template <class T>
concept Number = std::integral<T> || std::floating_point<T>;

/// Writes numbers one after the other into bytes that the caller owns. What does not fit is left
/// out and `overflowed` tells.
class ByteSink {
 public:
  explicit ByteSink(std::span<unsigned char> bytes) : bytes_(bytes) {}

  template <Number T>
  void number(T value) noexcept {
    if (bytes_.size() - size_ < sizeof(T)) {
      overflowed_ = true;
      return;
    }
    wire::put_little_endian(std::bit_cast<UnsignedOfSize<sizeof(T)>>(value), bytes_.subspan(size_));
    size_ += sizeof(T);
  }
  /// A number that is mostly small: seven bits a byte, the lowest first; 0, -1, 1, -2 as 0, 1, 2, 3.
  void small_number(std::int64_t value) noexcept {
    auto bits = (static_cast<std::uint64_t>(value) << 1U) ^ static_cast<std::uint64_t>(value >> 63U);
    for (; bits > 0x7FU; bits >>= 7U) number(static_cast<std::uint8_t>(bits | 0x80U));
    number(static_cast<std::uint8_t>(bits));
  }
  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  [[nodiscard]] bool overflowed() const noexcept { return overflowed_; }

 private:
  std::span<unsigned char> bytes_;
  std::size_t size_ = 0;
  bool overflowed_ = false;
};

/// Reads them back. Past the end it gives zeros and `ok` turns false for good.
class ByteSource {
 public:
  explicit ByteSource(std::span<const unsigned char> bytes) : bytes_(bytes) {}

  template <Number T>
  void number(T& value) noexcept {
    value = std::bit_cast<T>(bytes_.little<UnsignedOfSize<sizeof(T)>>());
  }
  void small_number(std::int64_t& value) noexcept {
    std::uint64_t bits = 0;
    std::uint8_t byte = 0x80;
    for (unsigned shift = 0; (byte & 0x80U) != 0; shift += 7) {
      if (shift > 63) return refuse();
      number(byte);
      bits |= static_cast<std::uint64_t>(byte & 0x7FU) << shift;
    }
    value = static_cast<std::int64_t>(bits >> 1U) ^ -static_cast<std::int64_t>(bits & 1U);
  }
  void refuse() noexcept { refused_ = true; }
  [[nodiscard]] bool ok() const noexcept { return bytes_.ok() && !refused_; }
  [[nodiscard]] std::size_t left() const noexcept { return bytes_.rest().size(); }

 private:
  wire::ByteReader bytes_;
  bool refused_ = false;
};

}  // namespace jaywalk
