#pragma once
// Every tick of a run, kept in a file without a name so that the live page can go back to any.
#include <cstdint>
#include <cstdio>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "firmware/safety/reasons.h"
#include "hal/types/geometry.h"

namespace jaywalk::view {
/// What of a tick the page's strip shows.
struct StripTick {
  double t_s = 0.0, wanted_mps = 0.0, permitted_mps = 0.0, speed_mps = 0.0;
  Vec2 at{};  ///< where the robot is, in the map
  Reason reasons = Reason::kNone;
};

/// Keeps frames in order, ticks from 0. Where the disk or kMostBytes is full, later ticks are not kept. Any thread; not
/// for a thread with a deadline.
class FrameStore {
 public:
  static constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 30U;

  /// The potential that frames from now on were made with; JSON.
  void add_field(std::string_view field);
  /// What a scan or a plan changed, from now on; JSON.
  void add_scene(std::string_view scene);
  /// The next tick; `head`: frame_head() of view_scene.h.
  void add(const StripTick& strip, std::string_view head);

  /// {"kind":"then","frame":...,"field":...}; empty where that tick is not kept. `field` null where there is none.
  [[nodiscard]] std::string then(std::uint64_t tick) const;
  /// {"kind":"past","step":N,"ticks":[[t, wanted, permitted, speed, reasons, x, y], ...]}: every Nth tick kept, `most`
  /// at most.
  [[nodiscard]] std::string past(std::size_t most) const;

 private:
  struct Piece {
    std::uint64_t at = 0;
    std::uint32_t size = 0;
  };
  struct Entry {
    StripTick strip;
    Piece head, scene, field;
  };
  [[nodiscard]] Piece put(std::string_view text);
  [[nodiscard]] std::string read(const Piece& piece) const;

  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  mutable std::mutex mutex_;
  std::unique_ptr<std::FILE, Close> file_{std::tmpfile()};
  std::uint64_t size_ = 0;
  bool full_ = file_ == nullptr;
  Piece scene_, field_;
  std::vector<Entry> entries_;
};

}  // namespace jaywalk::view
