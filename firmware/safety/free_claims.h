#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "hal/types/geometry.h"
#include "hal/types/laser_scan.h"

namespace jaywalk {
/// Filter of a scanner's claim that nothing is within reach (SAFETY 29): a free beam counts as unknown where it
/// contradicts the scans before.
///
/// A dead diode, a cover or a mirror reports "no echo" as open ground does. Each surface that a beam hit is expected
/// again where the wheels say that it must show. Between two hits, surfaces that turn free from one scan to the next
/// have vanished; a pedestrian uncovers at most their own way of what they hid, and is then seen beside it. More than
/// that is a fault of the scanner: its beams there are doubted until each has hit something in two scans. A scanner
/// without any hit for kSilent is doubted as a whole: indoors something is within reach.
///
/// Doubted beams are unknown to stop zone, tracker and map. Thread: the loop's; memory is fixed.
class FreeClaims {
 public:
  /// Judges a new scan. `now_from_before`: pose of the laser at the scan before, in its frame at this one.
  void take(const LaserScan& scan, const Pose2& now_from_before) noexcept;
  /// Sets the range of the doubted free beams of the scan that was taken last to 0.
  void strike_out(LaserScan& scan) const noexcept;

  static constexpr Duration kSilent = std::chrono::seconds(2);

 private:
  /// Surface that a beam is expected to hit.
  struct Surface {
    Vec2 in_laser{};
    Time seen = kNever;  ///< kNever: none
  };
  /// Beams close together that are free and should hit; beam numbers modulo the scan's.
  struct Vanished {
    std::size_t first = 0, last = 0, beams = 0;
    double width_m = 0.0;  ///< of what was there, across the beams
    double seen_s = 0.0;   ///< sum of the times since it was seen
  };
  enum class Doubt : std::uint8_t { kNone, kHitOnce, kVanished, kBeside };

  void learn_directions(const LaserScan& scan) noexcept;
  void expect(const LaserScan& scan, const Pose2& now_from_before) noexcept;
  [[nodiscard]] std::size_t beam_towards(Vec2 in_laser) const noexcept;
  void find_vanished(const LaserScan& scan) noexcept;
  void add(const LaserScan& scan, std::size_t beam, Vanished& vanished) const noexcept;
  [[nodiscard]] bool has_failed(const LaserScan& scan, const Vanished& vanished) const noexcept;
  [[nodiscard]] double moved_m(std::size_t beam, double range_m) const noexcept;
  /// Whether a surface beside it has moved since the scan before.
  [[nodiscard]] bool moves_beside(const LaserScan& scan, const Vanished& vanished) const noexcept;
  void doubt(const LaserScan& scan, const Vanished& vanished) noexcept;
  void believe_hits(const LaserScan& scan) noexcept;
  void remember(const LaserScan& scan) noexcept;
  [[nodiscard]] std::size_t at(std::size_t beam) const noexcept { return beam % beams_; }

  std::size_t beams_ = 0;
  double first_rad_ = 0.0, step_rad_ = 0.0;
  bool all_round_ = false;
  Time hit_ = kNever;  ///< stamp of the last scan with hits; of the first scan before one
  bool silent_ = false;
  std::array<Surface, kMaxBeams> surface_{},
      expected_{};  ///< of each beam, in the frame of the scan before and of this
  std::array<Doubt, kMaxBeams> doubt_{};
};

}  // namespace jaywalk
