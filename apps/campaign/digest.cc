#include "apps/campaign/digest.h"

#include <array>
#include <cstdint>
#include <fstream>

namespace jaywalk::campaign {
namespace {

constexpr std::uint64_t kOffset = 0xcbf29ce484222325U, kPrime = 0x100000001b3U;

std::uint64_t mixed(std::uint64_t hash, std::string_view bytes) {
  for (const char byte : bytes) hash = (hash ^ static_cast<unsigned char>(byte)) * kPrime;
  return hash;
}

std::string hexadecimal(std::uint64_t hash) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text(16, '0');
  for (std::size_t k = 16; k-- > 0; hash /= 16U) text[k] = kDigits[hash % 16U];
  return text;
}

}  // namespace

std::string digest_of_text(std::string_view text) { return hexadecimal(mixed(kOffset, text)); }

std::string digest_of_file(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::array<char, 1U << 16U> block{};
  std::uint64_t hash = kOffset;
  while (in.read(block.data(), block.size()) || in.gcount() > 0)
    hash = mixed(hash, {block.data(), static_cast<std::size_t>(in.gcount())});
  return hexadecimal(hash);
}

}  // namespace jaywalk::campaign
