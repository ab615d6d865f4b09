#pragma once
// The planner on the CUDA device at hand against the CPU's, for tools/gpu_acceptance. Each part prints a line of JSON
// last and returns 0: passed, or 1.
#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "bench/field/random_maps.h"
#include "cuda/paper/cuda_paper.h"

namespace jaywalk::acceptance {

using WallClock = std::chrono::steady_clock;

struct Options {
  std::vector<std::int32_t> sides{64, 128, 256, 512, 1024};
  int seeds = 20, ticks = 4, repeats = 1000;
  std::chrono::milliseconds limit = kLongestWait;  ///< a sanitizer takes its time
};

inline double ms_since(WallClock::time_point begin) {
  return std::chrono::duration<double, std::milli>(WallClock::now() - begin).count();
}

/// A window full of boxes with movers walking about; a robot on its way from corner to corner.
class Walk {
 public:
  Walk(std::int32_t side, std::uint64_t seed);
  /// The request of the next scan: for the paper's path among movers, or for the time to go of a long body.
  const PlanRequest& step(bool is_paper);
  [[nodiscard]] paper::PaperConfig config() const;
  PlanRequest request;

 private:
  std::int32_t side_;
  EvidenceMap map_;
  std::vector<Track> tracks_;
};

int parity(const Options& options);
int times(const Options& options);
int drill(const std::string& name);
int device();

// What keeps a device from serving. Each is false where it could not be done.
/// It is busy for half a second, or for good.
[[nodiscard]] bool occupy(bool for_good);
/// An error that stays.
[[nodiscard]] bool break_device();
/// No memory is left.
[[nodiscard]] bool fill_memory();
/// Name, compute capability, clocks: fields of JSON.
[[nodiscard]] std::string description();

}  // namespace jaywalk::acceptance
