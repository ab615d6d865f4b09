#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "hal/types/fixed_vector.h"
#include "hal/types/time.h"

namespace jaywalk {

inline constexpr std::size_t kMaxBeams = 2048;  ///< of a scan: 360 degrees at 0.18 degrees
inline constexpr std::size_t kLeastBeams = 3;   ///< with fewer it is no scanner

/// What one beam proves.
enum class BeamState : std::uint8_t {
  kHit,     ///< something stands at its range
  kFree,    ///< the device measured, and says that nothing is within its reach
  kUnknown  ///< nothing: lost, dirty, dazzled, too near, blanked, no number
};

/// One sweep of a planar laser scanner, in the laser's frame (x ahead, angles counter-clockwise).
///
/// A range is metres along its beam, and tells the beam's state:
///   [range_min_m, range_max_m)     hit
///   range_max_m and more, infinity free: the scanner measured, and found nothing within its reach (as REP 117 has it)
///   0, NaN, below range_min_m      unknown: a lost packet, dirt, dazzle, an error code, something too near
///   minus infinity                 unknown: before the beam stands the robot itself (blank())
/// Only hits and free beams prove free room. A decoder writes infinity only where its device says that it measured and
/// found nothing; where a code can mean anything else as well, it writes 0. The table of codes is in drivers/README.md.
struct LaserScan {
  Time stamp = kNever;           ///< when the first beam was measured
  std::uint32_t sequence = 0;    ///< grows by one a sweep; 0: no scan yet
  std::uint32_t beam_count = 0;  ///< beams in use, at most kMaxBeams
  float first_angle_rad = 0.0F;  ///< direction of beam 0
  float angle_step_rad = 0.0F;   ///< from a beam to the next; negative for scanners turning clockwise
  float range_min_m = 0.0F;
  float range_max_m = 0.0F;
  Duration sweep{0};   ///< from the first beam to the last; 0: taken all at once
  Duration period{0};  ///< nominal time from one scan to the next
  std::array<float, kMaxBeams> range_m{};
  std::uint8_t scanner = 0;  ///< which of the robot's it is from, in the order of its file; the loop says so

  [[nodiscard]] bool is_hit(std::size_t beam) const {
    const float r = range_m[beam];
    return r >= range_min_m && r < range_max_m && r > 0.0F;  // false for NaN
  }
  [[nodiscard]] bool found_nothing(std::size_t beam) const {
    const float r = range_m[beam];
    return r >= range_max_m && r > 0.0F;  // false for NaN
  }
  [[nodiscard]] bool too_near(std::size_t beam) const { return range_m[beam] < -std::numeric_limits<float>::max(); }
  [[nodiscard]] BeamState state(std::size_t beam) const {
    return is_hit(beam) ? BeamState::kHit : found_nothing(beam) ? BeamState::kFree : BeamState::kUnknown;
  }
  [[nodiscard]] double angle_rad(std::size_t beam) const {
    return static_cast<double>(first_angle_rad) + static_cast<double>(beam) * static_cast<double>(angle_step_rad);
  }
};

// Values of each scanner are kept as the first's and those of the others, in the order of the robot's file.

/// One at each corner.
inline constexpr std::size_t kMostScanners = 4;

template <class T>
using OfOthers = FixedVector<T, kMostScanners - 1>;

/// A view of what there is of each scanner. What it looks at outlives it.
template <class T>
class OfEach {
 public:
  OfEach(const T& first, std::span<const T> others = {}) noexcept : first_(&first), others_(others) {}
  /// `all`: one or more.
  explicit OfEach(std::span<const T> all) noexcept : OfEach(all.front(), all.subspan(1)) {}

  [[nodiscard]] std::size_t size() const noexcept { return 1 + others_.size(); }
  [[nodiscard]] const T& operator[](std::size_t scanner) const noexcept {
    return scanner == 0 ? *first_ : others_[scanner - 1];
  }

  struct Iterator {
    const OfEach& each;
    std::size_t at;
    const T& operator*() const noexcept { return each[at]; }
    Iterator& operator++() noexcept { return ++at, *this; }
    bool operator!=(const Iterator& other) const noexcept { return at != other.at; }
  };
  [[nodiscard]] Iterator begin() const noexcept { return {*this, 0}; }
  [[nodiscard]] Iterator end() const noexcept { return {*this, size()}; }

 private:
  const T* first_;
  std::span<const T> others_;
};

}  // namespace jaywalk
