#pragma once
// Which scanner answers, and what its scans are like, for `jaywalk setup`.
#include <optional>
#include <string>
#include <vector>

#include "firmware/robot/robot_file.h"
#include "hal/hal.h"

namespace jaywalk {

/// Where a scanner may be, and what it may speak there, in the order in which that is tried.
struct ScannerPlace {
  std::string host;        ///< or
  std::string device;      ///< a serial line
  std::uint16_t port = 0;  ///< 0: the maker's
  std::uint32_t baud = 0;  ///< 0: the maker's
  std::vector<ScannerKind> kinds;
};

struct FoundScanner {
  LaserWiring wiring;
  std::uint32_t beams = 0;
  double fov_deg = 0.0;  ///< from the first beam to the last
  double rate_hz = 0.0;
};

/// Everything a person may have meant by that line of a network or a cable.
[[nodiscard]] std::vector<ScannerKind> kinds_on_network();
[[nodiscard]] std::vector<ScannerKind> kinds_on_line();
/// What is tried on a serial line that nobody named, by its adapter's name: words go only to what is a scanner by name.
[[nodiscard]] std::vector<ScannerKind> kinds_by_adapter(const std::string& line);

/// Opens all places at once, makes each send by one kind's words, and listens: kind by kind, at most three seconds
/// each. The scanners of which scans came, in the places' order. A name that cannot be resolved has none. Start-up
/// only.
[[nodiscard]] std::vector<FoundScanner> find_scanners(const std::vector<ScannerPlace>& places, Clock& clock);

/// Where the scanner is connected: "192.168.0.1:2112", "/dev/ttyUSB0".
[[nodiscard]] std::string place_of(const FoundScanner& scanner);
/// "sick-cola-b at 192.168.0.1:2112: 811 beams over 270.00 degrees, 15 a second"
[[nodiscard]] std::string describe(const FoundScanner& scanner);

}  // namespace jaywalk
