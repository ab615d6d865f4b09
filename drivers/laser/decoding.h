#pragma once
#include <cstdint>
#include <string_view>

namespace jaywalk {

/// What came of bytes that should have been a scan. Except at kScan the scan that was to be filled is not to be used.
enum class Decoding : std::uint8_t {
  kScan,
  kOtherMessage,  ///< well formed, but no scan: an answer to a command
  kTruncated,     ///< ends before its fields do
  kChecksum,
  kBadField,      ///< a field that is no number, or one that no scanner sends
  kTooManyBeams,  ///< more than kMaxBeams
  kNoDistances,   ///< a scan without a channel of first distances
  kDeviceError,   ///< the scanner says that it is not well
  kDirty          ///< the scanner says that its window is too dirty to measure through
};

[[nodiscard]] std::string_view name(Decoding decoding) noexcept;

}  // namespace jaywalk
