#pragma once
#include <cmath>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "hal/types/time.h"
#include "hal/types/trig.h"
#include "hil/emulators/byte_server.h"

namespace jaywalk::emulators {

enum class ScannerFault : std::uint8_t {
  kNone,
  kReset,         ///< tears the connection, once
  kHalfTelegram,  ///< sends the first half of the next message, once
  kHalves,        ///< sends the first half of every message
  kDamage,        ///< changes a byte in the middle of every message
  kGarbage,       ///< sends noise instead of messages
  kSilence,       ///< neither scans nor answers
  kHeldBack,      ///< messages are sent all at once when this ends
  kDelayed,       ///< every message is sent 0.7 s late
  kGone           ///< nothing is there to connect to
};

/// The window as the scanner judges it.
enum class Window : std::uint8_t {
  kClean,
  kSoiled,  ///< it warns, and measures
  kDirty    ///< it can measure no more
};

/// Where the beams look and when; the same words as in hal's LaserScan.
struct SweepShape {
  std::size_t beams = 271;
  double first_angle_rad = 0.0;
  double angle_step_rad = 0.0;
  double rate_hz = 15.0;
  Duration sweep{0};    ///< from the first beam to the last
  Duration on_line{0};  ///< from a message's last beam to its last byte at the other end

  [[nodiscard]] double angle_rad(std::size_t beam) const {
    return first_angle_rad + angle_step_rad * static_cast<double>(beam);
  }
};

inline constexpr double kTurnsPerS = 10.0;
/// Of a laser that turns clockwise, so many beams a turn.
[[nodiscard]] inline SweepShape whole_turn(std::size_t beams) {
  const auto count = static_cast<double>(beams);
  return {.beams = beams,
          .angle_step_rad = -2.0 * kPi / count,
          .rate_hz = kTurnsPerS,
          .sweep = duration_from_seconds((count - 1.0) / count / kTurnsPerS)};
}

/// The nearest whole number of counts of `count_m` metres to `range_m`, 0 or more.
[[nodiscard]] inline std::uint32_t in_counts(float range_m, double count_m) noexcept {
  return static_cast<std::uint32_t>(std::floor(static_cast<double>(range_m) / count_m + 0.5));
}

/// A scanner at the far end of a wire: sweeps without end, asks the world for ranges while it does, and tells its
/// clients. It shares no code with the driver that it talks to, except how numbers stand in bytes.
class ScannerServer {
 public:
  /// Fills in the ranges (m) that beams `first_beam` onwards measure at this moment, as in hal's LaserScan: infinity
  /// where nothing is within reach, 0 where nothing could be measured. Each kind of scanner says both in its own codes.
  using World = std::function<void(std::size_t first_beam, std::span<float> range_m)>;

  /// Messages of `beams_per_message` beams; a sweep holds a whole number of them.
  ScannerServer(std::unique_ptr<ByteServer> wire, const SweepShape& shape, std::size_t beams_per_message, World world);
  virtual ~ScannerServer() = default;

  /// Takes what came in, measures the beams whose time has come, and sends the messages that are complete. Called about
  /// once a millisecond; an irregular caller makes irregular scans, as a busy scanner does.
  void step(Time now);
  /// From now on, for `duration` where it is something that lasts; takes the place of what was ordered before.
  void order(ScannerFault fault, Duration duration = Duration{0});

  /// Makes these beams, or those that look into a sector (rad, counter-clockwise), measure nothing from now on and say
  /// `says_m` (World): infinity as a dead diode may. What else was lost stays so.
  void lose_beams(std::size_t first, std::size_t count, float says_m = 0.0F) {
    for (std::size_t k = first; k < std::min(first + count, says_m_.size()); ++k) says_m_[k] = says_m;
  }
  void lose_sector(double from_rad, double to_rad, float says_m = 0.0F);
  void find_beams() noexcept { says_m_.assign(says_m_.size(), kMeasures); }
  /// From now on each message is damaged with this probability, 0 to 1.
  void damage_share(double share) noexcept { damaged_share_ = share; }
  /// False where this kind of scanner has no word for dirt.
  [[nodiscard]] virtual bool set_window(Window) { return false; }

  [[nodiscard]] const SweepShape& shape() const noexcept { return shape_; }
  /// Messages with ranges, a sweep each for most scanners.
  [[nodiscard]] std::uint64_t messages_sent() const noexcept { return messages_sent_; }
  [[nodiscard]] std::uint64_t peers() const noexcept { return wire_->peers(); }
  [[nodiscard]] bool is_streaming() const noexcept { return streaming_; }

 protected:
  using Message = std::vector<std::uint8_t>;
  using Ranges = std::span<const float>;

  /// A peer connected: what the one before had set for its connection is forgotten.
  virtual void on_new_peer() {}
  virtual void on_bytes(wire::Bytes) {}
  /// The beams from `first_beam` on, just measured, as a message. `began` is when the sweep's first was.
  [[nodiscard]] virtual Message message_of(std::size_t first_beam, Ranges range_m, Time began, Time now) = 0;

  void set_streaming(bool on) noexcept { streaming_ = on; }
  void answer(wire::Bytes bytes) { wire_->write(bytes); }
  void answer(std::string_view text) { answer({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}); }

 private:
  void end_fault(Time now);
  void serve_peer();
  void measure(Time now);
  void measure_until_now(Time now);
  void tell_measured(Time now);
  void send(Message message, Time now);
  [[nodiscard]] std::uint8_t noise() noexcept {
    return static_cast<std::uint8_t>((noise_ = noise_ * 1664525U + 1013904223U) >> 24U);
  }
  void send_held(Time now);

  struct Held {
    Time due = kNever;
    Message message;
  };

  std::unique_ptr<ByteServer> wire_;
  SweepShape shape_;
  std::size_t beams_per_message_;
  World world_;
  std::vector<float> range_m_;
  static constexpr float kMeasures = -1.0F;
  std::vector<float> says_m_;  ///< for each beam, instead of what it measures; kMeasures where it does
  double damaged_share_ = 0.0;
  std::deque<Held> held_;
  std::size_t measured_ = 0, told_ = 0;  ///< beams of this sweep
  Time began_ = kNever;
  bool streaming_ = false;
  std::uint64_t peers_seen_ = 0;
  std::uint64_t messages_sent_ = 0;
  ScannerFault fault_ = ScannerFault::kNone;
  Duration fault_lasts_{0};
  Time fault_ends_ = kNever;
  std::uint32_t noise_ = 1;
};

}  // namespace jaywalk::emulators
