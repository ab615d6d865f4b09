#pragma once
// What recorders pack their bytes with.
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace jaywalk::exchange {

/// `packed` in zstd's frames, lz4's frames or bzip2's, by the names that the formats give them: "zstd", "lz4", "bz2";
/// "" and "none" are not packed. `bytes`: how many come out, exactly. Nothing where they do not.
[[nodiscard]] std::optional<std::string> unpack(std::string_view method, std::string_view packed, std::size_t bytes);
/// Whether unpack() knows the method.
[[nodiscard]] bool can_unpack(std::string_view method);

/// zstd's frames that do not say how much comes out, at most `most` bytes.
[[nodiscard]] std::optional<std::string> unpack_zstd(std::string_view packed, std::size_t most);

/// One of zstd's frames, at its fastest usual level.
[[nodiscard]] std::string packed_zstd(std::string_view bytes);

}  // namespace jaywalk::exchange
