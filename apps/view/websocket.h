#pragma once
// The server's end of the WebSocket protocol (RFC 6455): the key of the handshake, frames out and frames in.
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace jaywalk::view {

/// SHA-1 (FIPS 180-4): the handshake is defined by it. Not for secrets.
[[nodiscard]] std::array<std::uint8_t, 20> sha1(std::string_view text);
/// RFC 4648, section 4, with padding.
[[nodiscard]] std::string base64(std::string_view bytes);
/// What answers a client's Sec-WebSocket-Key (section 4.2.2).
[[nodiscard]] std::string accept_key(std::string_view key);

enum class Opcode : std::uint8_t { kContinuation = 0, kText = 1, kBinary = 2, kClose = 8, kPing = 9, kPong = 10 };

/// One whole unmasked frame, as a server sends it (section 5.2).
[[nodiscard]] std::string to_frame(Opcode opcode, std::string_view payload);

struct ClientFrame {
  Opcode opcode = Opcode::kText;
  std::string payload;
};

enum class FrameState { kIncomplete, kWhole, kRefused };

/// Takes one frame from the front of `received`. Refused are frames without a mask, in fragments, with reserved bits,
/// or longer than kMostPayload: the connection is to be closed then.
[[nodiscard]] FrameState take_frame(std::string& received, ClientFrame& frame);

inline constexpr std::size_t kMostPayload =
    8192;  ///< bytes; orders have about 50, an advertisement with its schema some hundred

}  // namespace jaywalk::view
