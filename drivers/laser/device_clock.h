#pragma once
#include <cstdint>

#include "hal/types/time.h"

namespace jaywalk {

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
