#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "firmware/safety/wheel_proof.h"
#include "hal/types/geometry.h"
#include "hal/types/laser_scan.h"
#include "hal/types/robot_model.h"

namespace jaywalk {

/// Filter of a scanner's claim that nothing is within reach (SAFETY 29): a free beam counts as unknown where it
/// contradicts the scans before.
///
/// A dead diode, a cover or a mirror reports "no echo" as open ground does. Surfaces that turn free from one scan to
/// the next, where the wheels say that they must show, have vanished; a pedestrian uncovers at most their own way of
/// what they hid, and is then seen beside it. More than that is a fault: the beams there are doubted until each has hit
/// something in two scans; all of them where none hits for kSilent, for indoors something is within reach. Doubted
/// beams are unknown to stop zone, tracker and map. Thread: the loop's; memory is fixed.
class FreeClaims {
 public:
  /// Judges a new scan. `now_from_before`: pose of the laser at the scan before, in its frame at this one.
  void take(const LaserScan& scan, const Pose2& now_from_before) noexcept;
  /// Sets the range of the doubted free beams of the scan that was taken last to 0.
  void strike_out(LaserScan& scan) const noexcept;

  static constexpr Duration kSilent = std::chrono::seconds(2);

 private:
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

/// Raindrops, snow, dust: returns that neither neighbours nor earlier scans repeat are no obstacle.
///
/// A body of 2 cm or more is believed at once, by the beams that it fills; the stop zone's 70 mm always are (SAFETY 8).
/// A thinner body is believed with the third scan that has it at the same place in the world, by the wheels' motion.
/// Until then its range is told with a minus sign: it proves nothing, and a recording keeps it.
class LoneReturns {
 public:
  /// As FreeClaims::take(). Cost: some ten steps for each beam.
  void take(const LaserScan& scan, const Pose2& now_from_before) noexcept;
  void strike_out(LaserScan& scan) const noexcept;

 private:
  static constexpr std::uint8_t kBelieved = 3;  ///< scans

  /// A scan with its returns, and how often each was seen; 0: no return.
  struct Look {
    LaserScan scan;
    std::array<std::uint8_t, kMaxBeams> times{};
  };

  /// Most times that the scan before had something at a place in its frame.
  [[nodiscard]] std::uint8_t times_before(Vec2 place) const noexcept;

  Look now_, before_;
};

/// Filter of one scanner's beams before anything uses them: hits on the robot itself, lone returns and doubted free
/// beams prove nothing. Without wheels only hits on the robot are taken out. A scan that was filtered before stays as
/// it is, so that recordings replay. Thread: the loop's; memory is fixed.
class BeamFilter {
 public:
  BeamFilter(const RobotModel& model, std::size_t scanner, bool has_wheels = true);

  /// Once a tick, with the scanner's newest scan as it came and the wheels' newest reading.
  void filter(LaserScan& scan, const WheelState& wheels) noexcept;

 private:
  [[nodiscard]] Pose2 now_from_before(Time stamp) noexcept;

  LaserModel laser_;
  double track_width_m_;
  bool has_wheels_;
  WheelTravel travel_;
  std::uint32_t sequence_ = 0;
  std::optional<Rolled> rolled_;  ///< at the scan before
  LoneReturns lone_returns_;
  FreeClaims free_claims_;
};

}  // namespace jaywalk
