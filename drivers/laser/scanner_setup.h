#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "drivers/laser/scanner_connection.h"

namespace jaywalk {

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

/// "sick-cola-a", "sick-cola-b", "hokuyo", "ld19" (and LD06), "lms200", "rplidar", "dds" (a ROS 2 topic, by
/// jaywalk_dds); nothing for other names.
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
