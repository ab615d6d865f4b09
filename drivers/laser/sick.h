#pragma once
// SICK TiM5xx and LMS1xx: scan telegrams, and what makes them come.
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "drivers/laser/scanner_protocol.h"
#include "drivers/wire/byte_reader.h"
#include "hal/types/fixed_vector.h"
#include "hal/types/laser_scan.h"

namespace jaywalk::sick {

enum class Cola : std::uint8_t { kA, kB };

/// Longest body that is believed: two channels of 2048 beams are 8.3 kB in CoLa B, some 12 to 20 kB in CoLa A.
inline constexpr std::size_t kMaxBody = 24576;

/// Cuts a stream into telegrams; after garbage it goes on at the next beginning that holds.
class ColaStream : public wire::ByteQueue<2 * kMaxBody> {
 public:
  explicit ColaStream(Cola dialect) noexcept : dialect_(dialect) {}

  /// Another connection begins.
  void begin(Cola dialect) noexcept {
    dialect_ = dialect;
    clear();
  }
  /// The next whole telegram's body, without framing; nothing until more bytes came. Valid until the next append.
  [[nodiscard]] std::optional<wire::Bytes> next() noexcept { return dialect_ == Cola::kA ? next_a() : next_b(); }

 private:
  [[nodiscard]] std::optional<wire::Bytes> next_a() noexcept;
  [[nodiscard]] std::optional<wire::Bytes> next_b() noexcept;

  Cola dialect_;
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
  std::uint16_t telegram_counter = 0;
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
[[nodiscard]] Heard decode_scan(Cola dialect, wire::Bytes body, const ScannerModel& model, Time arrival,
                                LaserScan& scan, ScanHeader& header) noexcept;

/// Makes a TiM5xx or LMS1xx send scans: log in as authorised client, first distances of 16 bits and nothing else in
/// each telegram, run, scans on. What is set is not saved in the scanner. Only the last command must be taken; a
/// scanner that refuses another or does not answer it sends scans as it was set before, and that is counted. `dialect`
/// is what is spoken first: a scanner that was never understood is spoken to in the other one on the next connection.
class SickProtocol final : public ScannerProtocol {
 public:
  SickProtocol(Cola dialect, const ScannerModel& model) noexcept : dialect_(dialect), model_(model), stream_(dialect) {}

  void begin() noexcept override;
  [[nodiscard]] wire::Bytes to_say(Time now) noexcept override;
  [[nodiscard]] bool go_on_unanswered() noexcept override { return conclude(false); }
  void hear(wire::Bytes bytes) noexcept override { stream_.append(bytes); }
  [[nodiscard]] Heard next(Time arrival, LaserScan& scan) noexcept override;
  [[nodiscard]] ProtocolCounts counts() const noexcept override {
    return {lost_, stream_.skipped(), refused_, warned_};
  }

 private:
  [[nodiscard]] Heard on_answer(std::string_view body) noexcept;
  /// The command was taken, or not: on to the next. False where it must be taken.
  [[nodiscard]] bool conclude(bool taken) noexcept;
  void count_lost(std::uint16_t telegram_counter) noexcept;

  Cola dialect_;
  ScannerModel model_;
  ColaCommand said_;
  std::size_t at_ = 0;  ///< index of the set-up command to send next, or whose answer is pending
  bool tried_ = false, understood_ = false;
  ColaStream stream_;
  DeviceClock device_clock_{std::chrono::microseconds(1), std::uint64_t{1} << 32U};
  std::optional<std::uint16_t> last_counter_;
  std::uint64_t lost_ = 0, refused_ = 0, warned_ = 0;  ///< as in ProtocolCounts
};

}  // namespace jaywalk::sick
