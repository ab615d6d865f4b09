#pragma once
// What writer and reader of MCAP (mcap.dev/spec) share.
#include <zlib.h>

#include <cstdint>
#include <string_view>

namespace jaywalk::exchange {

inline constexpr std::string_view kMcapMagic{"\x89MCAP0\r\n", 8};

enum McapOp : std::uint8_t {
  kHeader = 1,
  kFooter = 2,
  kSchema = 3,
  kChannel = 4,
  kMessage = 5,
  kChunk = 6,
  kMessageIndex = 7,
  kChunkIndex = 8,
  kAttachment = 9,
  kAttachmentIndex = 10,
  kStatistics = 11,
  kSummaryOffset = 14,
  kDataEnd = 15
};

/// Of zlib and PNG; `so_far`: of what came before.
[[nodiscard]] inline std::uint32_t crc_of(std::string_view bytes, std::uint32_t so_far = 0) {
  return static_cast<std::uint32_t>(
      crc32(so_far, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size())));
}

}  // namespace jaywalk::exchange
