#pragma once
#include <cstdint>

#include "drivers/laser/decoding.h"
#include "drivers/wire/byte_reader.h"
#include "hal/types/laser_scan.h"

namespace jaywalk {

/// What a message from a scanner was.
enum class Heard : std::uint8_t {
  kNothing,      ///< no whole message yet
  kScan,         ///< the scan is filled, all but its sequence
  kAnswer,       ///< to a command, or something that is of no interest
  kMalformed,    ///< a message that does not hold what it should
  kDeviceError,  ///< the scanner says that it is not well
  kDirty,        ///< the scanner says that its window is too dirty to measure through
  kRefused       ///< it will not send scans
};

/// What a message was, as far as its decoding tells.
[[nodiscard]] constexpr Heard heard_of(Decoding decoding) noexcept {
  switch (decoding) {
    case Decoding::kScan:
      return Heard::kScan;
    case Decoding::kOtherMessage:
      return Heard::kAnswer;
    case Decoding::kDeviceError:
      return Heard::kDeviceError;
    case Decoding::kDirty:
      return Heard::kDirty;
    default:
      return Heard::kMalformed;
  }
}

/// Since start, over all connections.
struct ProtocolCounts {
  std::uint64_t lost = 0;           ///< scans that the scanner numbered and that did not come
  std::uint64_t skipped_bytes = 0;  ///< that belonged to no message
  std::uint64_t refused = 0;        ///< commands that the scanner refused or did not answer, and can do without
  std::uint64_t warned = 0;         ///< messages in which the scanner warned, of dirt on its window for one
  bool operator==(const ProtocolCounts&) const = default;
};

/// One side of the conversation with one kind of scanner: what is said so that scans come, and what is heard. It
/// knows nothing of sockets. Nothing here waits, allocates or throws. Thread: one.
class ScannerProtocol {
 public:
  virtual ~ScannerProtocol() = default;
  /// A connection begins: what was half said and half heard before is forgotten.
  virtual void begin() noexcept = 0;
  /// The next command, handed out once; empty while an answer is awaited and when all is said. Valid until begin().
  [[nodiscard]] virtual wire::Bytes to_say(Time now) noexcept = 0;
  [[nodiscard]] virtual bool awaits_answer() const noexcept = 0;
  /// The answer does not come: false where that is the end, true where the conversation goes on without it.
  [[nodiscard]] virtual bool go_on_unanswered() noexcept { return false; }
  virtual void hear(wire::Bytes bytes) noexcept = 0;
  /// The next message of what was heard, whose last byte came in at `arrival`. `scan` may be spoilt except at kScan.
  [[nodiscard]] virtual Heard next(Time arrival, LaserScan& scan) noexcept = 0;
  [[nodiscard]] virtual ProtocolCounts counts() const noexcept = 0;
};

}  // namespace jaywalk
