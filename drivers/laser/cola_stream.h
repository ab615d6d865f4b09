#pragma once
// SICK's command language on a byte stream: CoLa A (STX, text, ETX) and CoLa B (four STX, length, body, XOR).
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "drivers/wire/byte_reader.h"
#include "hal/types/fixed_vector.h"

namespace jaywalk::sick {

[[nodiscard]] inline std::string_view text_of(wire::Bytes bytes) noexcept {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

enum class Cola : std::uint8_t { kA, kB };
[[nodiscard]] constexpr Cola other(Cola dialect) noexcept { return dialect == Cola::kA ? Cola::kB : Cola::kA; }

/// Cuts a stream into telegrams; after garbage it goes on at the next beginning that holds.
class ColaStream {
 public:
  /// Longest body that is believed: two channels of 2048 beams are 8.3 kB in CoLa B, some 12 to 20 kB in CoLa A.
  static constexpr std::size_t kMaxBody = 24576;

  explicit ColaStream(Cola dialect) noexcept : dialect_(dialect) {}

  void append(wire::Bytes bytes) noexcept { queue_.append(bytes); }
  /// Drops what waits, uncounted: another connection begins.
  void begin(Cola dialect) noexcept {
    dialect_ = dialect;
    queue_.clear();
    handed_out_ = 0;
  }
  /// The next whole telegram's body, without framing; nothing until more bytes came. Valid until the next call.
  [[nodiscard]] std::optional<wire::Bytes> next() noexcept;

  /// Bytes that belonged to no telegram.
  [[nodiscard]] std::uint64_t skipped() const noexcept { return skipped_ + queue_.lost(); }
  [[nodiscard]] std::uint64_t bad_checksums() const noexcept { return bad_checksums_; }

 private:
  [[nodiscard]] std::optional<wire::Bytes> next_a() noexcept;
  [[nodiscard]] std::optional<wire::Bytes> next_b() noexcept;
  void skip(std::size_t count) noexcept;

  Cola dialect_;
  wire::ByteQueue<2 * kMaxBody> queue_;
  std::size_t handed_out_ = 0;  ///< bytes of the telegram that the caller still looks at
  std::uint64_t skipped_ = 0;
  std::uint64_t bad_checksums_ = 0;
};

using ColaCommand = FixedVector<std::uint8_t, 128>;

/// A command with its framing, ready to send: "sEN LMDscandata 1" asks for scans in CoLa A. In CoLa B arguments are
/// bytes, not digits. Empty where it does not fit.
[[nodiscard]] ColaCommand framed(Cola dialect, std::string_view command) noexcept;

}  // namespace jaywalk::sick
