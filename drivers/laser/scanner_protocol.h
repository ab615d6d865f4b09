#pragma once
// Conversation with a scanner, and what its kinds share: decoding, turns, device clock.

#include <array>
#include <cstddef>
#include <cstdint>

#include "drivers/wire/byte_reader.h"
#include "hal/types/laser_scan.h"
#include "hal/types/time.h"

namespace jaywalk {

/// What a message from a scanner was. Except at kScan the scan that was to be filled is not to be used.
enum class Heard : std::uint8_t {
  kNothing,      ///< no whole message yet
  kScan,         ///< the scan is filled, all but its sequence
  kAnswer,       ///< to a command, or something that is of no interest
  kMalformed,    ///< a message that does not hold what it should
  kDeviceError,  ///< the scanner says that it is not well
  kDirty,        ///< the scanner says that its window is too dirty to measure through
  kRefused       ///< it will not send scans
};

/// Since start, over all connections.
struct ProtocolCounts {
  std::uint64_t lost = 0;           ///< scans that the scanner numbered and that did not come
  std::uint64_t skipped_bytes = 0;  ///< that belonged to no message
  std::uint64_t refused = 0;        ///< commands that the scanner refused or did not answer, and can do without
  std::uint64_t warned = 0;         ///< messages in which the scanner warned, of dirt on its window for one
  bool operator==(const ProtocolCounts&) const = default;
};

/// One side of the conversation with one kind of scanner: what is said so that scans come, and what is heard. It
/// knows nothing of sockets. Nothing here waits, allocates or throws. Thread: one.
class ScannerProtocol {
 public:
  virtual ~ScannerProtocol() = default;
  /// A connection begins: what was half said and half heard before is forgotten.
  virtual void begin() noexcept = 0;
  /// The next command, handed out once; empty while an answer is awaited and when all is said. Valid until the next.
  [[nodiscard]] virtual wire::Bytes to_say(Time /*now*/) noexcept { return {}; }
  [[nodiscard]] virtual bool awaits_answer() const noexcept { return asked_; }
  /// The answer does not come: false where that is the end, true where the conversation goes on without it.
  [[nodiscard]] virtual bool go_on_unanswered() noexcept { return false; }
  virtual void hear(wire::Bytes bytes) noexcept = 0;
  /// The next message of what was heard, whose last byte came in at `arrival`. `scan` may be spoilt except at kScan.
  [[nodiscard]] virtual Heard next(Time arrival, LaserScan& scan) noexcept = 0;
  [[nodiscard]] virtual ProtocolCounts counts() const noexcept = 0;

 protected:
  bool asked_ = false;  ///< a command, and its answer did not come yet
};

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

/// How long messages were under way, as a device's own clock tells.
///
/// The fastest message so far is taken for one that was not held up; any other is late by what the device's clock and
/// ours disagree about more than then. So scans that lay in a buffer look as old as they are. Ours is believed to run
/// up to kDrift faster than the device's, and the fastest is forgotten at that rate.
class DeviceClock {
 public:
  /// Two crystals of 100 ppm, and as much again.
  static constexpr double kDrift = 400e-6;

  /// The device counts `tick` by `tick` and begins again at 0 after `wrap` ticks.
  constexpr DeviceClock(Duration tick, std::uint64_t wrap) noexcept : tick_(tick), wrap_(wrap) {}

  /// A new connection: the device may have been restarted.
  void forget() noexcept { *this = DeviceClock(tick_, wrap_); }

  /// How much longer than the fastest message this one was under way, 0 or more, which the device gave the stamp
  /// `ticks`, below wrap, and which came in at `arrival`. Between two calls lies less than a wrap.
  [[nodiscard]] Duration delay(std::uint64_t ticks, Time arrival) noexcept {
    const bool first = last_arrival_ == kNever;
    if (!first) {
      sent_ += tick_ * static_cast<std::int64_t>((ticks % wrap_ + wrap_ - last_ticks_) % wrap_);
      fastest_ += duration_from_seconds(to_seconds(arrival - last_arrival_) * kDrift);
    }
    last_ticks_ = ticks % wrap_;
    last_arrival_ = arrival;
    const Duration under_way = arrival.time_since_epoch() - sent_;
    if (first || under_way < fastest_) fastest_ = under_way;
    return under_way - fastest_;
  }

 private:
  Duration tick_;
  std::uint64_t wrap_;
  std::uint64_t last_ticks_ = 0;
  Time last_arrival_ = kNever;
  Duration sent_{0};     ///< on the device's clock, unwrapped, since the first message
  Duration fastest_{0};  ///< from the device's clock to ours
};

}  // namespace jaywalk
