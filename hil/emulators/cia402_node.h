#pragma once
#include <cstdint>
#include <optional>
#include <string_view>

#include "drivers/canopen/cia402.h"
#include "hal/types/fixed_vector.h"
#include "hil/emulators/motor_node.h"

namespace jaywalk::emulators {

/// The object dictionary of an emulated drive, and the SDO server before it (expedited transfers only).
class DriveObjects {
 public:
  /// Those of a CiA 402 drive with two PDOs each way, switched off, watching nobody.
  DriveObjects() noexcept;

  /// 0 for what is not there.
  [[nodiscard]] std::uint32_t value(canopen::ObjectAddress address) const noexcept;
  /// What the drive itself does; nothing happens for what is not there.
  void set(canopen::ObjectAddress address, std::uint32_t value) noexcept {
    if (Object* const object = find(address)) object->value = value;
  }
  /// The answer to an SDO request addressed to `node`; nothing where `frame` is none.
  [[nodiscard]] std::optional<CanFrame> answer(std::uint8_t node, const CanFrame& frame) noexcept;

  void lack(canopen::ObjectAddress address) noexcept;
  /// From now on it is read-only and holds this.
  void fix(canopen::ObjectAddress address, std::uint32_t value) noexcept;
  /// From now on writes are acknowledged and change nothing.
  void lie_about(canopen::ObjectAddress address) noexcept {
    if (Object* const object = find(address)) object->lies = true;
  }
  /// Makes its TPDOs answer no remote frames: bit 30 of their COB-IDs stays set whatever is written; `strict`: a write
  /// without it is refused.
  void know_no_remote_frames(bool strict) noexcept;
  /// Shortens its SDO answers to the bytes in use.
  void answer_short() noexcept { short_ = true; }

  /// What it holds now is what a restart brings back (1010h).
  void store() noexcept {
    for (Object& object : objects_) object.stored = object.value;
  }
  /// Power lost, or NMT reset: what was not stored is forgotten; of communication (1000h to 1FFFh) alone, or all.
  void restore(bool all) noexcept;

 private:
  struct Object {
    canopen::ObjectAddress address;
    std::uint8_t bytes = 0;
    std::uint32_t value = 0;
    std::uint32_t stored = 0;
    bool writable = true;
    bool lies = false;
  };

  void add(canopen::ObjectAddress address, std::uint8_t bytes, std::uint32_t value, bool writable) noexcept;
  [[nodiscard]] Object* find(canopen::ObjectAddress address) noexcept;
  [[nodiscard]] std::uint32_t write(canopen::ObjectAddress address, std::uint32_t value, std::size_t bytes) noexcept;

  FixedVector<Object, 64> objects_;
  bool keeps_bit_30_ = false, wants_bit_30_ = false, short_ = false;
};

/// A CANopen drive with a motor that follows its ramps exactly: SDO server, PDOs at SYNC as they are mapped, heartbeat
/// both ways, the CiA 402 state machine as a drive sees it. In counts; its node is 1 to 127.
///
/// Network states (CiA 301): after power-up it says boot-up and is Pre-operational. Outside Operational it takes and
/// sends no PDO, Stopped it answers no SDO either, and in none of them does that by itself stop the motor, which goes
/// on at the last target. What stops it is its watch over the controller's heartbeat (1016h, 6007h), in every state;
/// heard_controller() is kNever again once that is missed.
class Cia402Node final : public MotorNode {
 public:
  using MotorNode::MotorNode;

  void step(Time now) override;

  [[nodiscard]] DriveObjects& objects() noexcept { return objects_; }
  [[nodiscard]] std::string_view state_name() const noexcept override;

  /// Something broke: it brakes, says so in an emergency message and waits in "fault".
  void raise_fault(std::uint32_t error_code) noexcept override;
  /// Power lost and back: forgets what was not stored, no torque; the motor rolls out.
  void restart() noexcept override;
  /// From now on it goes Operational by itself after a restart (as 1F80h can have it).
  void start_by_itself() noexcept { starts_by_itself_ = true; }
  void show_mode_after_enabling(Duration delay) noexcept override { mode_delay_ = delay; }
  /// Its mode never shows: it stays in another one.
  void keep_mode(std::uint8_t mode) noexcept { kept_mode_ = mode; }
  /// Its heartbeats are 8 bytes long, the first of them the state.
  void pad_heartbeats() noexcept { heartbeat_size_ = 8; }
  /// Its position is another one at once, as after an index pulse or a slip of its counter.
  void jump(double counts) noexcept { slipped_ += counts; }
  void lose_feedback() noexcept override { reports_ = false; }

 private:
  enum class State { kSwitchOnDisabled, kReady, kSwitchedOn, kOperationEnabled, kQuickStop, kFaultReaction, kFault };

  /// Its network state (CiA 301), as its heartbeat says it.
  enum class Network : std::uint8_t { kStopped = 0x04, kOperational = 0x05, kPreOperational = 0x7F };

  void take(const CanFrame& frame, Time now) noexcept override;
  void take_network_command(std::uint8_t command) noexcept;
  [[nodiscard]] bool take_request(const CanFrame& frame) noexcept;
  void take_targets(const CanFrame& frame) noexcept;
  void boot() noexcept;
  void on_sync() noexcept;
  void show() noexcept;
  [[nodiscard]] std::uint32_t shown_mode() const noexcept;
  void transmit(std::uint16_t communication, std::uint16_t mapping) noexcept;
  void obey(std::uint16_t controlword) noexcept;
  void watch(Time now) noexcept override;
  void lose_controller() noexcept;
  void move(double seconds) noexcept override;
  void say(Time now) noexcept override;
  void send(std::uint32_t id, std::uint64_t word, std::uint8_t size) noexcept;
  void send_emergency(std::uint16_t error_code) noexcept {
    if (network_ != Network::kStopped) send(0x080U + node_, error_code, 8);
  }

  DriveObjects objects_;
  State state_ = State::kSwitchOnDisabled;
  Network network_ = Network::kPreOperational;
  bool booted_ = false;  ///< and has said so
  bool starts_by_itself_ = false, reports_ = true;
  std::uint16_t pending_controlword_ = 0;  ///< of the last PDO, until SYNC
  std::int32_t pending_target_ = 0;
  std::uint16_t last_controlword_ = 0;
  double friction_ = 100.0;  ///< counts/s2: a tenth of the ramp with which it drove last
  double slipped_ = 0.0;
  std::optional<Duration> mode_delay_;
  std::optional<std::uint8_t> kept_mode_;
  Time enabled_ = kNever;  ///< since when
  std::uint8_t heartbeat_size_ = 1;
  Time said_heartbeat_ = kNever;
};

}  // namespace jaywalk::emulators
