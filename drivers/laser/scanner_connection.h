#pragma once
#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <thread>

#include "drivers/laser/scanner_protocol.h"
#include "drivers/wire/byte_link.h"
#include "hal/hal.h"
#include "hal/mailbox.h"

namespace jaywalk {

/// Why no scans come.
enum class ScannerTrouble : std::uint8_t {
  kNone,
  kUnreachable,  ///< it could not be opened
  kClosed,       ///< it closed the connection, or the wire is gone
  kNoAnswer,     ///< to a command
  kRefused,      ///< it will not send scans
  kSilent,       ///< connected, and nothing comes that is a scan
  kLate,         ///< scans come, but too long after they were taken
  kDeviceError,  ///< it says itself that it is not well
  kDirty         ///< it says itself that its window is too dirty
};

[[nodiscard]] std::string_view name(ScannerTrouble trouble) noexcept;

/// How it goes. Counts are since start.
struct ScannerHealth {
  ScannerTrouble trouble = ScannerTrouble::kUnreachable;  ///< none while scans come; unreachable before the first try
  ScannerTrouble last_trouble = ScannerTrouble::kNone;    ///< the latest there was
  std::uint64_t scans = 0;
  std::uint64_t malformed = 0;  ///< messages that did not hold what they should
  std::uint64_t late = 0;       ///< scans that came too late to be of use, or no later than the one before
  std::uint64_t connections = 0;
  ProtocolCounts protocol;
  bool operator==(const ScannerHealth&) const = default;
};

/// A scanner on a wire as the HAL's laser. It connects, says what makes the scanner send, decodes, and begins anew
/// where anything goes wrong. While no scans come, `latest` stays at the last one, whose stamp grows old.
///
/// Threads: `start` makes one that owns the wire; the loop's thread calls `latest` and `health`. Without `start`,
/// `step` is called by hand. The clock is read in the wire's thread too: it must not mind that. No memory is taken
/// after construction.
class ScannerConnection final : public LaserScanner {
 public:
  /// `clock` outlives it.
  ScannerConnection(std::unique_ptr<wire::Link> link, std::unique_ptr<ScannerProtocol> protocol, Clock& clock)
      : link_(std::move(link)), protocol_(std::move(protocol)), clock_(clock) {}
  ~ScannerConnection() override;

  /// `priority` of SCHED_FIFO, 1 to 98, for the thread; 0: an ordinary one. False where the kernel does not permit it:
  /// then it is an ordinary one, started all the same.
  bool start(int priority = 0);
  /// Does what can be done at once.
  void step() noexcept;

  [[nodiscard]] const LaserScan& latest() noexcept override { return scans_.latest(); }
  [[nodiscard]] ScannerHealth health() noexcept { return healths_.latest(); }
  /// As a person would name the scanner's place.
  [[nodiscard]] const std::string& name() const noexcept { return link_->name(); }

 private:
  enum class Phase : std::uint8_t { kResting, kOpening, kTalking };

  /// From one try to the next; doubles with each that brought no scan. The first is long enough for scans to grow too
  /// old, one and a half periods of 5 Hz or more: a wire that broke stops the robot however soon it is whole again.
  static constexpr Duration kFirstRest = std::chrono::milliseconds(300), kLongestRest = std::chrono::milliseconds(1600);

  void await_opening(Time now) noexcept;
  void talk(Time now) noexcept;
  void take_messages(Time arrival) noexcept;
  void take_scan(Time arrival) noexcept;
  void watch(Time now) noexcept;
  void give_up(ScannerTrouble why, Time now) noexcept;
  void suffer(ScannerTrouble why) noexcept { health_.trouble = health_.last_trouble = why; }
  void tell_health() noexcept;

  std::unique_ptr<wire::Link> link_;
  std::unique_ptr<ScannerProtocol> protocol_;
  Clock& clock_;

  Phase phase_ = Phase::kResting;
  Time rest_until_ = kNever;
  Duration rest_ = kFirstRest;
  Time opened_ = kNever;    ///< when opening began
  Time progress_ = kNever;  ///< of the last scan that was not late, or of the last command that was answered
  Time last_stamp_ = kNever;
  bool scan_late_ = false;  ///< the last one was
  std::array<std::uint8_t, 4096> room_{};
  std::uint32_t sequence_ = 0;
  ScannerHealth health_, told_;

  Mailbox<LaserScan> scans_;
  Mailbox<ScannerHealth> healths_;
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

enum class ScannerKind : std::uint8_t { kSickColaA, kSickColaB, kHokuyo, kLdrobot, kLms200, kRplidar, kDds };

/// What a kind has by its maker.
struct ScannerMake {
  std::string_view name;  ///< in files
  ScannerKind kind;
  std::uint16_t port;  ///< 0: not on a network
  std::uint32_t baud;  ///< 0: not on a serial line
};

[[nodiscard]] std::span<const ScannerMake> scanner_makes() noexcept;
[[nodiscard]] const ScannerMake& scanner_make(ScannerKind kind) noexcept;

/// By ScannerMake::name; nothing for other names.
[[nodiscard]] std::optional<ScannerKind> scanner_kind(std::string_view name) noexcept;

/// Where a scanner is and what it does not say of itself.
struct ScannerSetup {
  ScannerKind kind = ScannerKind::kSickColaB;
  std::string host{};         ///< on a network: name or address
  std::uint16_t port = 0;     ///< 0: the maker's own, 2112 for SICK, 10940 for Hokuyo
  std::string device{};       ///< on a serial line: "/dev/ttyUSB0"
  std::uint32_t baud = 0;     ///< 0: the maker's own
  float range_min_m = 0.05F;  ///< SICK on a network; the others say theirs or have it by their kind
  float range_max_m = 10.0F;
  std::string topic{};            ///< ROS 2 only; `device` is then the path of its shared ring
  bool infinity_is_free = false;  ///< ROS 2 only: infinity means free room, not a failed measurement
};

/// The scanner, not started yet. Throws StartupError where the setup cannot be: neither host nor device, both, or one
/// that this kind of scanner does not have. `clock` outlives it.
[[nodiscard]] std::unique_ptr<ScannerConnection> make_scanner(const ScannerSetup& setup, Clock& clock);

}  // namespace jaywalk
