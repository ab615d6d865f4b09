#include "apps/view/websocket.h"

#include <bit>

namespace jaywalk::view {
namespace {

using Words = std::array<std::uint32_t, 5>;

std::uint32_t mixed(std::size_t round, const Words& h) {
  if (round < 20) return ((h[1] & h[2]) | (~h[1] & h[3])) + 0x5A827999U;
  if (round < 40) return (h[1] ^ h[2] ^ h[3]) + 0x6ED9EBA1U;
  if (round < 60) return ((h[1] & h[2]) | (h[1] & h[3]) | (h[2] & h[3])) + 0x8F1BBCDCU;
  return (h[1] ^ h[2] ^ h[3]) + 0xCA62C1D6U;
}

void add_block(std::string_view block, Words& hash) {
  std::array<std::uint32_t, 80> w{};
  for (std::size_t i = 0; i < 64; ++i) w[i / 4] = (w[i / 4] << 8U) | static_cast<std::uint8_t>(block[i]);
  for (std::size_t i = 16; i < 80; ++i) w[i] = std::rotl(w[i - 3] ^ w[i - 8] ^ w[i - 14] ^ w[i - 16], 1);
  Words h = hash;
  for (std::size_t i = 0; i < 80; ++i)
    h = {std::rotl(h[0], 5) + mixed(i, h) + h[4] + w[i], h[0], std::rotl(h[1], 30), h[2], h[3]};
  for (std::size_t i = 0; i < 5; ++i) hash[i] += h[i];
}

/// `count` bytes of a number, the highest first.
std::string big_endian(std::uint64_t number, std::size_t count) {
  std::string bytes(count, '\0');
  for (std::size_t i = 0; i < count; ++i) bytes[count - 1 - i] = static_cast<char>((number >> (8 * i)) & 0xFFU);
  return bytes;
}

/// Payloads up to 125 bytes tell their length in the head, those up to 65535 in two bytes behind it.
constexpr std::size_t kTwoByteLength = 126, kEightByteLength = 127;

}  // namespace

std::array<std::uint8_t, 20> sha1(std::string_view text) {
  std::string padded(text);
  padded += '\x80';
  while (padded.size() % 64 != 56) padded += '\0';
  padded += big_endian(8 * text.size(), 8);
  Words hash{0x67452301U, 0xEFCDAB89U, 0x98BADCFEU, 0x10325476U, 0xC3D2E1F0U};
  for (std::size_t i = 0; i < padded.size(); i += 64) add_block(std::string_view(padded).substr(i, 64), hash);
  std::array<std::uint8_t, 20> bytes{};
  for (std::size_t i = 0; i < 20; ++i) bytes[i] = static_cast<std::uint8_t>(hash[i / 4] >> (24 - 8 * (i % 4)));
  return bytes;
}

std::string base64(std::string_view bytes) {
  constexpr char kLetters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = (group << 8U) | (i + k < bytes.size() ? static_cast<std::uint8_t>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k) out += i + k > bytes.size() ? '=' : kLetters[(group >> (18 - 6 * k)) & 63U];
  }
  return out;
}

std::string accept_key(std::string_view key) {
  const auto digest = sha1(std::string(key) + "258EAFA5-E914-47DA-95CA-C5AB0DC85B11");
  return base64(std::string(digest.begin(), digest.end()));
}

std::string to_frame(Opcode opcode, std::string_view payload) {
  std::string frame(1, static_cast<char>(0x80U | static_cast<unsigned>(opcode)));
  if (payload.size() < kTwoByteLength) {
    frame += static_cast<char>(payload.size());
  } else if (payload.size() <= 0xFFFF) {
    frame += static_cast<char>(kTwoByteLength) + big_endian(payload.size(), 2);
  } else {
    frame += static_cast<char>(kEightByteLength) + big_endian(payload.size(), 8);
  }
  return frame += payload;
}

FrameState take_frame(std::string& received, ClientFrame& frame) {
  const auto byte = [&](std::size_t i) -> std::size_t { return static_cast<std::uint8_t>(received[i]); };
  if (received.size() < 2) return FrameState::kIncomplete;
  const bool whole = (byte(0) & 0xF0U) == 0x80U, masked = (byte(1) & 0x80U) != 0;
  std::size_t length = byte(1) & 0x7FU, head = 2;
  if (!whole || !masked || length == kEightByteLength) return FrameState::kRefused;
  if (length == kTwoByteLength) {
    if (received.size() < 4) return FrameState::kIncomplete;
    length = byte(2) << 8U | byte(3), head = 4;
  }
  if (length > kMostPayload) return FrameState::kRefused;
  if (received.size() < head + 4 + length) return FrameState::kIncomplete;
  frame.opcode = static_cast<Opcode>(byte(0) & 0x0FU);
  frame.payload.clear();
  for (std::size_t i = 0; i < length; ++i) frame.payload += static_cast<char>(byte(head + 4 + i) ^ byte(head + i % 4));
  received.erase(0, head + 4 + length);
  return FrameState::kWhole;
}

}  // namespace jaywalk::view
