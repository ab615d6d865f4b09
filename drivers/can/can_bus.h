#pragma once
#include <cstdint>
#include <string_view>

#include "drivers/can/can_frame.h"

namespace jaywalk {

/// What a controller says about itself (ISO 11898-1 error states), and what may be wrong around it.
enum class CanState : std::uint8_t {
  kActive,   ///< all is well
  kWarning,  ///< an error counter above 96
  kPassive,  ///< above 127: it may no longer destroy others' frames
  kBusOff,   ///< above 255: it takes no part until it is restarted
  kDown      ///< the interface is down or gone
};

enum class SendResult : std::uint8_t {
  kQueued,      ///< the controller has it; that it reached anybody is for others to say
  kQueueFull,   ///< ENOBUFS: nobody acknowledges, or too much at once
  kOffBus,      ///< interface down, gone, or bus-off
  kNotAFrame,   ///< is_valid said no
  kSystemError  ///< anything else that the kernel refuses
};

[[nodiscard]] std::string_view name(CanState state) noexcept;
[[nodiscard]] std::string_view name(SendResult result) noexcept;

struct CanHealth {
  CanState state = CanState::kActive;
  std::uint64_t error_frames = 0;  ///< since start
  std::uint64_t bus_off_count = 0;
  std::uint64_t frames_lost = 0;  ///< dropped because they were not fetched in time
  std::uint64_t malformed = 0;    ///< what the kernel handed over and was no frame
};

/// Frames that one tick takes in: a bus at 1 Mbit/s brings some 9000 a second.
inline constexpr int kMostFramesATick = 512;

/// One place on a CAN bus. Nothing here waits, allocates or throws; one thread uses it.
class CanBus {
 public:
  virtual ~CanBus() = default;
  [[nodiscard]] virtual SendResult send(const CanFrame& frame) noexcept = 0;
  /// Takes the oldest frame that waits; false when there is none. Own frames do not come back.
  [[nodiscard]] virtual bool receive(ReceivedFrame& received) noexcept = 0;
  /// As known from what was received so far.
  [[nodiscard]] virtual CanHealth health() const noexcept = 0;
};

/// Whether a bus was well since it was last looked at. Thread: the bus's.
class BusWatch {
 public:
  /// What was before is forgotten.
  void begin(const CanHealth& health) noexcept { bus_offs_seen_ = health.bus_off_count; }
  /// False when the controller is passive, off or down now, or was off meanwhile: that may be over before anybody
  /// looks.
  [[nodiscard]] bool is_well(const CanHealth& health) noexcept {
    const bool takes_part = health.state == CanState::kActive || health.state == CanState::kWarning;
    const bool was_off = health.bus_off_count != bus_offs_seen_;
    begin(health);
    return takes_part && !was_off;
  }

 private:
  std::uint64_t bus_offs_seen_ = 0;
};

}  // namespace jaywalk
