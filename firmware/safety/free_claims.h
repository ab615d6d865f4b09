#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "firmware/safety/wheel_travel.h"
#include "hal/types/laser_scan.h"
#include "hal/types/robot_model.h"

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
/// Doubted beams are unknown to all that follows: stop zone, tracker and map. A scan that was judged before is left as
/// it is, so that a recording replays. Thread: the loop's; memory is fixed.
class FreeClaims {
 public:
  FreeClaims(const RobotModel& model, std::size_t scanner);

  /// Once a tick with the scanner's newest scan as it came, whose doubted free beams get the range 0.
  void judge(LaserScan& scan, const WheelState& wheels) noexcept;

  static constexpr Duration kSilent = std::chrono::seconds(2);

 private:
  /// What a beam's free is held against.
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

  void take(const LaserScan& scan) noexcept;
  void learn_directions(const LaserScan& scan) noexcept;
  [[nodiscard]] Pose2 laser_motion(Time stamp) noexcept;
  void expect(const LaserScan& scan, const Pose2& before_from_now) noexcept;
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

  DriveModel drive_;
  Pose2 robot_from_laser_;
  WheelTravel travel_;
  std::uint32_t sequence_ = 0;
  std::size_t beams_ = 0;
  double first_rad_ = 0.0, step_rad_ = 0.0;
  bool all_round_ = false;
  Rolled rolled_;  ///< at the scan before
  bool rolled_known_ = false;
  Time hit_ = kNever;  ///< stamp of the last scan with hits; of the first scan before one
  bool silent_ = false;
  std::array<Surface, kMaxBeams> surface_{},
      expected_{};  ///< of each beam, in the frame of the scan before and of this
  std::array<Doubt, kMaxBeams> doubt_{};
};

}  // namespace jaywalk
