#pragma once
#include <filesystem>
#include <string>
#include <string_view>

namespace jaywalk::campaign {

/// FNV-1a, 64 bits (Fowler, Noll and Vo; RFC 9923), as 16 hexadecimal digits: tells files apart, keeps no secret.
[[nodiscard]] std::string digest_of_text(std::string_view text);
/// Of a file's bytes; of nothing where it cannot be read.
[[nodiscard]] std::string digest_of_file(const std::filesystem::path& file);

}  // namespace jaywalk::campaign
