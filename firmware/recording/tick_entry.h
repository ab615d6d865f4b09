#pragma once
// One tick's record as bytes: the fields in the order of tick_entry.cc, little endian, without padding. A scan and a
// fix are written only where their sequence is new; only beams in use count. What a robot of several scanners has
// beyond that stands at the end: of one scanner there is nothing.
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

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

}  // namespace jaywalk
