#pragma once
#include <algorithm>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "hil/emulators/scanners.h"
#include "tests/drivers/scanner_bench.h"

namespace jaywalk::tests {

using ScannerWorld = emulators::ScannerServer::World;

/// A wall at 2 m all around.
inline void round_room(std::size_t, std::span<float> range_m) { std::fill(range_m.begin(), range_m.end(), 2.0F); }

/// A scanner of a kind in `world`; none, and "skipped" said, where this machine has no pseudo terminals.
using MakeScanner = std::unique_ptr<ScannerBench> (*)(const ScannerWorld& world);

[[nodiscard]] std::unique_ptr<ScannerBench> sick_bench(
    const ScannerWorld& world, emulators::ColaDialect dialect = emulators::ColaDialect::kBinary);
[[nodiscard]] std::unique_ptr<ScannerBench> hokuyo_bench(const ScannerWorld& world,
                                                         const emulators::ScipModel& model = {});
[[nodiscard]] std::unique_ptr<ScannerBench> lms200_bench(const ScannerWorld& world);
[[nodiscard]] std::unique_ptr<ScannerBench> rplidar_bench(const ScannerWorld& world);
[[nodiscard]] std::unique_ptr<ScannerBench> ld_bench(const ScannerWorld& world);

/// A row of the table: a kind of scanner on a wire, its rates, and how what may happen to any scanner happens to it.
struct ScannerKind {
  const char* name;
  MakeScanner make;
  std::size_t beams;
  Duration period;
  std::uint64_t least_scans;  ///< of two seconds, less what the conversation took and a turn seen in part
  Duration early, late;       ///< a stamp may be so long before and after its first beam was measured
  Duration oldest = std::chrono::milliseconds(300);        ///< most that a stamp is ago
  Duration conversation = std::chrono::milliseconds(300);  ///< from a connection to a first whole scan, at most
  bool on_network = false;
  bool whole = true;             ///< a damaged message costs its scan; otherwise a few sectors
  std::uint64_t half_bytes = 0;  ///< of half a message, at least, that is counted as one lost; 0: not counted so
  std::function<void(ScannerBench&, bool)> set_error = {};  ///< it reports an error; none: it has no word for it
  std::function<void(ScannerBench&)> refuse_scans = {};     ///< it will not scan; none: it cannot say so
};

[[nodiscard]] const std::vector<ScannerKind>& scanner_kinds();

/// `body(kind, bench)` for each kind that this machine has a wire for, in a section of its own.
template <class Body>
void with_each_scanner(const ScannerWorld& world, Body body) {
  for (const ScannerKind& kind : scanner_kinds()) {
    DYNAMIC_SECTION(kind.name) {
      if (const auto bench = kind.make(world)) body(kind, *bench);
    }
  }
}

}  // namespace jaywalk::tests
