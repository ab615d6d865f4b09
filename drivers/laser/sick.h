#pragma once
// SICK TiM5xx and LMS1xx: scan telegrams, and what makes them come.
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "drivers/laser/scanner_protocol.h"
#include "drivers/wire/byte_reader.h"
#include "hal/types/fixed_vector.h"
#include "hal/types/laser_scan.h"

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

 private:
  [[nodiscard]] std::optional<wire::Bytes> next_a() noexcept;
  [[nodiscard]] std::optional<wire::Bytes> next_b() noexcept;
  void skip(std::size_t count) noexcept;

  Cola dialect_;
  wire::ByteQueue<2 * kMaxBody> queue_;
  std::size_t handed_out_ = 0;  ///< bytes of the telegram that the caller still looks at
  std::uint64_t skipped_ = 0;
};

using ColaCommand = FixedVector<std::uint8_t, 128>;

/// A command with its framing, ready to send: "sEN LMDscandata 1" asks for scans in CoLa A. In CoLa B arguments are
/// bytes, not digits. Empty where it does not fit.
[[nodiscard]] ColaCommand framed(Cola dialect, std::string_view command) noexcept;

/// What the telegram does not say about a TiM5xx or LMS1xx.
struct ScannerModel {
  float range_min_m = 0.05F;
  float range_max_m = 10.0F;
};

/// What a telegram says beside the scan.
struct ScanHeader {
  std::uint32_t serial_number = 0;
  std::uint16_t telegram_counter = 0;
  std::uint16_t scan_counter = 0;
  std::uint32_t scan_time_us = 0;  ///< the device's clock at the end of the sweep; wraps after 71 minutes
  std::uint32_t sent_time_us = 0;  ///< the same clock when it was handed to the interface
  bool warns_of_dirt = false;      ///< on its window; it can still measure
};

/// Decodes the body of an "LMDscandata" telegram into `scan`, all but its sequence, which is the caller's.
///
/// `arrival` is when its last byte came in; the scan's stamp is the first beam's time: arrival less the time that the
/// device held the scan (not believed beyond one period) less the sweep. Angles are turned so that 90 degrees of SICK,
/// straight ahead, are 0. Reserved distances, 0 above all, prove nothing: SICK says 0 for nothing in range as well as
/// for what is too dark or too near. What is farther than the model's greatest range leaves the beam free. Channels
/// other than DIST1 are passed over.
[[nodiscard]] Decoding decode_scan(Cola dialect, wire::Bytes body, const ScannerModel& model, Time arrival,
                                   LaserScan& scan, ScanHeader& header) noexcept;

/// Makes a TiM5xx or LMS1xx send scans: log in as authorised client, first distances of 16 bits and nothing else in
/// each telegram, run, scans on. What is set is not saved in the scanner. Only the last command must be taken; a
/// scanner that refuses another or does not answer it sends scans as it was set before, and that is counted. `dialect`
/// is what is spoken first: a scanner that was never understood is spoken to in the other one on the next connection.
class SickProtocol final : public ScannerProtocol {
 public:
  SickProtocol(Cola dialect, const ScannerModel& model) noexcept;

  void begin() noexcept override;
  [[nodiscard]] wire::Bytes to_say(Time now) noexcept override;
  [[nodiscard]] bool awaits_answer() const noexcept override { return asked_; }
  [[nodiscard]] bool go_on_unanswered() noexcept override { return conclude(false); }
  void hear(wire::Bytes bytes) noexcept override { stream_.append(bytes); }
  [[nodiscard]] Heard next(Time arrival, LaserScan& scan) noexcept override;
  [[nodiscard]] ProtocolCounts counts() const noexcept override;

 private:
  struct Step {
    ColaCommand command;
    std::string_view word;  ///< of the command, which its answer repeats
  };

  void speak(Cola dialect) noexcept;
  [[nodiscard]] Heard on_answer(std::string_view body) noexcept;
  /// The command was taken, or not: on to the next. False where it must be taken.
  [[nodiscard]] bool conclude(bool taken) noexcept;
  void count_lost(std::uint16_t telegram_counter) noexcept;

  Cola dialect_;
  ScannerModel model_;
  std::array<Step, 4> steps_;
  std::size_t at_ = 0;  ///< the step that is said next, or whose answer is awaited
  bool asked_ = false;
  bool tried_ = false, understood_ = false;
  ColaStream stream_;
  DeviceClock device_clock_{std::chrono::microseconds(1), std::uint64_t{1} << 32U};
  bool has_counter_ = false;
  std::uint16_t last_counter_ = 0;
  std::uint64_t lost_ = 0;
  std::uint64_t refused_ = 0;
  std::uint64_t warned_ = 0;
};

}  // namespace jaywalk::sick
