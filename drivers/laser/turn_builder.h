#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "hal/types/laser_scan.h"

namespace jaywalk {

/// Makes scans of the single points of a scanner that turns clockwise without end: a turn begins where the angle passes
/// straight ahead.
///
/// Points lie at uneven angles; they are put into equal sectors, the nearest hit of a sector counts (as is right for
/// what must not be hit). A sector without a hit is free where all its points found nothing within reach; one with a
/// point that proves nothing, or with none at all (a lost packet), is unknown: it holds 0. One that was only stepped
/// over, by less than 1.5 sectors from point to point, holds the nearer of the two where both were measured. The first
/// turn, seen in part, is not handed out.
class TurnBuilder {
 public:
  static constexpr std::uint32_t kMostSectors = 512;

  /// `sectors` is 1 to kMostSectors.
  TurnBuilder(std::uint32_t sectors, float range_min_m, float range_max_m) noexcept
      : sectors_(sectors), range_min_m_(range_min_m), range_max_m_(range_max_m) {}

  /// A point at `angle_deg` clockwise from ahead, 0 to 360, measured at `measured`. True when it is the first of a new
  /// turn: then `scan` holds the one before, all but its sequence. Otherwise `scan` is left alone.
  [[nodiscard]] bool add(double angle_deg, float range_m, Time measured, LaserScan& scan) noexcept;
  /// The next turn is one seen in part.
  void forget() noexcept { began_ = kNever; }

 private:
  void put(float range_m, float& sector) const noexcept;
  void fill_stepped_over(std::size_t sector, float range_m) noexcept;
  void close_turn(Time end, LaserScan& scan) const noexcept;

  std::uint32_t sectors_;
  float range_min_m_, range_max_m_;
  std::array<float, kMostSectors> sector_m_{};  ///< as in a scan, and NaN where a point proved nothing
  Time began_ = kNever;
  double last_angle_deg_ = 0.0;
  std::size_t last_sector_ = 0;
  float last_range_m_ = 0.0F;
};

}  // namespace jaywalk
