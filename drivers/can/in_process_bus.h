#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "drivers/can/can_bus.h"
#include "hal/hal.h"

namespace jaywalk {

/// What goes wrong on an in-process bus, to order.
struct BusFaults {
  double loss = 0.0;  ///< share of frames that one receiver misses, in [0, 1]; drawn for each receiver
  Duration delay{0};  ///< from send to receive
};

/// A CAN bus inside one process: what one port sends, every other port receives, in the order sent.
///
/// For tests and emulators; no arbitration by identifier, no bit times. The same seed and the same calls give the
/// same losses. A receive queue holds kQueue frames; one more is lost and counted, as in a kernel's socket.
/// Thread: one for all ports.
class InProcessBus {
 public:
  static constexpr std::size_t kPorts = 8, kQueue = 128;

  /// The clock outlives the bus; its time decides when delayed frames arrive.
  InProcessBus(Clock& clock, std::uint64_t seed) noexcept : clock_(clock), random_(seed) {
    for (Port& port : ports_) port.bus_ = this;
  }
  InProcessBus(const InProcessBus&) = delete;
  InProcessBus& operator=(const InProcessBus&) = delete;

  class Port final : public CanBus {
   public:
    [[nodiscard]] bool send(const CanFrame& frame) noexcept override;
    [[nodiscard]] bool receive(ReceivedFrame& received) noexcept override;
    [[nodiscard]] CanHealth health() const noexcept override { return health_; }

    /// The controller's error state from now on; off the bus it neither sends nor receives, and what waited is gone.
    void set_state(CanState state) noexcept;
    /// The next `count` sends find the queue full.
    void refuse_sends(std::size_t count) noexcept { refusals_ = count; }

   private:
    friend class InProcessBus;
    [[nodiscard]] bool on_bus() const noexcept {
      return health_.state != CanState::kBusOff && health_.state != CanState::kDown;
    }
    void enqueue(const ReceivedFrame& frame) noexcept;

    InProcessBus* bus_ = nullptr;
    CanHealth health_;
    std::size_t refusals_ = 0;
    std::array<ReceivedFrame, kQueue> waiting_{};  ///< a ring; stamps are arrival times and do not decrease
    std::size_t oldest_ = 0;
    std::size_t count_ = 0;
  };

  /// `index` below kPorts.
  [[nodiscard]] Port& port(std::size_t index) noexcept { return ports_[index]; }
  /// For frames sent from now on; a shorter delay lets none overtake another.
  void set_faults(const BusFaults& faults) noexcept { faults_ = faults; }

 private:
  void deliver(const CanFrame& frame, const Port& sender) noexcept;
  [[nodiscard]] bool draw_loss() noexcept;

  Clock& clock_;
  BusFaults faults_;
  std::uint64_t random_;
  Time last_arrival_ = kNever;
  std::array<Port, kPorts> ports_;
};

}  // namespace jaywalk
