#pragma once
// Counts of measurements in bins of a fixed relative width.
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace jaywalk {

/// 64 bins for each doubling, each 0.8 to 1.6 % wide, from 2^-20 (a millionth) to 2^20; what is less counts as 0, what
/// is more in the last bin. The greatest value is kept as it is. 20 kB; adding neither allocates nor throws.
class LogHistogram {
 public:
  void add(double value) noexcept;
  [[nodiscard]] std::uint64_t count() const noexcept { return count_; }
  [[nodiscard]] double max() const noexcept { return max_; }
  /// The upper edge of the bin that holds the smallest value that at least `share` of all do not exceed (nearest rank),
  /// the greatest value at most: too great by 1.6 % at most. NaN when there are none.
  [[nodiscard]] double quantile(double share) const noexcept;
  /// Upper edge and count of each doubling that holds any; the first is 0 where values were below 2^-20.
  [[nodiscard]] std::vector<std::pair<double, std::uint64_t>> doublings() const;

 private:
  static constexpr int kLowest = -20, kHighest = 20, kPerDoubling = 64;
  static constexpr std::size_t kBins = static_cast<std::size_t>(kHighest - kLowest) * kPerDoubling + 1;
  [[nodiscard]] static std::size_t bin_of(double value) noexcept;
  [[nodiscard]] static double upper_edge(std::size_t bin) noexcept;

  std::array<std::uint64_t, kBins> bins_{};  ///< the first: what counts as 0
  std::uint64_t count_ = 0;
  double max_ = 0.0;
};

/// How well a loop with a thread of its own kept time, from its first tick on.
struct LoopTimes {
  LogHistogram wake_late_us;  ///< from when a tick was due to when the thread woke
  LogHistogram tick_us;       ///< from waking to the end of the tick, the status and the trace included
  std::uint64_t minor_faults = 0, major_faults = 0;  ///< page faults of that thread; major: the disk was waited for
};

}  // namespace jaywalk
