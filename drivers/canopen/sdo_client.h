#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "drivers/can/can_bus.h"
#include "drivers/canopen/cia402.h"
#include "drivers/wire/byte_reader.h"

namespace jaywalk::canopen {

enum class SdoStatus : std::uint8_t {
  kIdle,            ///< nothing asked yet
  kBusy,            ///< under way
  kDone,            ///< written; or read, and value() holds it
  kAbortedByDrive,  ///< abort_code() says why
  kAbortedHere,     ///< abort_code() says why, and the drive was told
  kNotSent          ///< the bus did not take a frame
};

/// Reads and writes objects of one node, one at a time (CiA 301, SDO protocol): a drive may answer a read in segments.
///
/// Never waits: `read` or `write` starts a transfer, every frame of the bus goes through `on_frame`, and `poll` ends
/// a transfer that got no answer for `timeout`. A value longer than kMaxBytes is aborted as "out of memory".
class SdoClient {
 public:
  static constexpr std::size_t kMaxBytes = 256;

  /// `bus` outlives the client; `node` is 1 to 127.
  SdoClient(CanBus& bus, std::uint8_t node, Duration timeout) noexcept : bus_(bus), node_(node), timeout_(timeout) {}

  /// False, and nothing changed, while a transfer is under way.
  [[nodiscard]] bool read(ObjectAddress address, Time now) noexcept;
  [[nodiscard]] bool write(const ObjectWrite& object, Time now) noexcept;

  /// Any frame of the bus; those that are not this node's answers are passed over.
  void on_frame(const CanFrame& frame, Time now) noexcept;
  void poll(Time now) noexcept;

  [[nodiscard]] SdoStatus status() const noexcept { return status_; }
  [[nodiscard]] std::uint32_t abort_code() const noexcept { return abort_code_; }
  /// What was read, as it stood on the wire (least significant byte first); valid while status() is kDone.
  [[nodiscard]] wire::Bytes value() const noexcept { return {buffer_.data(), size_}; }

 private:
  enum class Phase : std::uint8_t { kNone, kReadStart, kReadSegments, kWrite };

  void start(Phase phase, ObjectAddress address, Time now) noexcept;
  void send(const std::array<std::uint8_t, 8>& bytes) noexcept;
  void send_addressed(std::uint8_t command, std::uint32_t word) noexcept;
  void finish(SdoStatus status, std::uint32_t code = 0) noexcept;
  void abort_here(std::uint32_t code) noexcept;
  [[nodiscard]] bool append(wire::Bytes bytes) noexcept;

  void on_read_start(const CanFrame& frame) noexcept;
  void on_read_segment(const CanFrame& frame) noexcept;
  void ask_segment() noexcept;

  CanBus& bus_;
  std::uint8_t node_;
  Duration timeout_;
  SdoStatus status_ = SdoStatus::kIdle;
  Phase phase_ = Phase::kNone;
  ObjectAddress address_;
  Time heard_ = kNever;  ///< last progress
  std::uint32_t abort_code_ = 0;
  bool toggle_ = false;
  std::optional<std::size_t> announced_size_;
  std::array<std::uint8_t, kMaxBytes> buffer_{};
  std::size_t size_ = 0;  ///< of the value
};

/// Why a transfer of an object was given up (CiA 301, SDO abort codes): those that this client sends itself.
inline constexpr std::uint32_t kAbortToggle = 0x05030000, kAbortTimeout = 0x05040000, kAbortUnknownCommand = 0x05040001,
                               kAbortNoMemory = 0x05040005, kAbortLength = 0x06070010;
/// What a drive says of an object that it keeps as it is.
inline constexpr std::uint32_t kAbortReadOnly = 0x06010002;

/// In words; "unknown reason" for a code that the standard does not list.
[[nodiscard]] std::string_view abort_name(std::uint32_t code) noexcept;

}  // namespace jaywalk::canopen
