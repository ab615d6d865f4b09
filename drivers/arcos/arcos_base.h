#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "drivers/motor/motor_pair.h"
#include "drivers/wire/byte_reader.h"

namespace jaywalk::arcos {

/// Numbers of commands. Before the connection is open 0, 1 and 2 are SYNC's, in this order.
enum class Command : std::uint8_t {
  kPulse = 0,
  kOpen = 1,
  kClose = 2,
  kEnable = 4,             ///< motors on (1), off (0)
  kAcceleration = 5,       ///< mm/s2; negative: deceleration
  kTop = 6,                ///< mm/s
  kTurnTop = 10,           ///< degrees/s
  kSpeed = 11,             ///< mm/s
  kSettings = 18,          ///< asks for them, once
  kEncoders = 19,          ///< 2: with every report
  kTurn = 21,              ///< degrees/s, counter-clockwise
  kTurnAcceleration = 23,  ///< degrees/s2; negative: deceleration
  kSonar = 28,             ///< on (1), off (0)
  kStop = 29,              ///< both speeds zero, by the ramps
  kEmergencyStop = 55      ///< the same, as fast as it can
};

struct Word {
  Command command = Command::kPulse;
  std::int16_t argument = 0;  ///< of those that take one
};

/// A word as it stands on the line.
struct Packet {
  std::array<std::uint8_t, 9> bytes{};
  std::size_t size = 0;
  [[nodiscard]] wire::Bytes on_line() const noexcept { return {bytes.data(), size}; }
};

[[nodiscard]] Packet packet_of(const Word& word) noexcept;
/// Sum of big-endian pairs; an odd last byte is exclusive-ored.
[[nodiscard]] std::uint16_t checksum(wire::Bytes body) noexcept;

/// Finds packets in a stream of bytes; what is damaged is skipped.
struct PacketReader : wire::ByteQueue<1024> {
  /// The next packet's body, without header and checksum, until the next append; empty: none is whole.
  [[nodiscard]] wire::Bytes next() noexcept;
};

/// Bits of Report::faults.
enum Fault : std::uint32_t { kLeftStall = 1, kRightStall = 0x100, kStopButton = 0x200000, kMotorStall = 0x400000 };

/// What it says each cycle.
struct Report {
  std::array<double, 2> speed_mmps{};  ///< left, right
  std::uint32_t faults = 0;
  bool motors_on = false;
};
/// Counts of both wheels' encoders, which wrap: left, right.
using Encoders = std::array<std::uint32_t, 2>;

struct Settings {
  std::array<char, 24> type{}, subtype{};  ///< ended by zero; longer ones are cut
  std::uint8_t cycle_ms = 0;               ///< between two reports
  std::uint16_t watchdog_ms = 0, ticks_per_mm = 0;
  std::uint16_t top_mmps = 0, turn_top_dps = 0;
  std::uint16_t acceleration_mmps2 = 0, deceleration_mmps2 = 0;
  std::uint16_t turn_acceleration_dps2 = 0, turn_deceleration_dps2 = 0;
};

/// Nothing where the body is of another kind, or too short.
[[nodiscard]] std::optional<Report> report_in(wire::Bytes body) noexcept;
[[nodiscard]] std::optional<Encoders> encoders_in(wire::Bytes body) noexcept;
[[nodiscard]] std::optional<Settings> settings_in(wire::Bytes body) noexcept;

/// Ramps and fastest speeds that the board is set to at each connection.
struct MotionSettings {
  std::int16_t ramp_mmps2 = 0, turn_ramp_dps2 = 0;  ///< of speeding up and slowing down
  std::int16_t top_mmps = 0, turn_top_dps = 0;
};

struct BaseSetup {
  std::string name;                    ///< of its serial line, or its address
  std::array<double, 2> mm_per_rad{};  ///< left, right: way that the board counts a radian of the wheel
  double track_mm = 0.0;               ///< by which its wheels' speeds differ in a turn
  int ticks_per_mm = 0;                ///< of its encoders
  MotionSettings motion;
  /// Shortest and longest watchdog that it may be set to: it must outlast two commands.
  Duration watchdog_least = std::chrono::milliseconds(40), watchdog_most = std::chrono::milliseconds(100);
  StopLimits stop;  ///< braking and tolerance must be given
  bool allow_unproved = false;
  Duration tick = std::chrono::milliseconds(20);
  DriveTimes times{};  ///< of its reports
};

/// A Pioneer's own board (ARCOS) that takes speed and turn, as two motors.
///
/// Commands are at least 5 ms apart: each tick tells one word, that of speed and turn which is farther from what was
/// told, or STOP for zero. The board's watchdog stops the wheels, and **the board goes on with its old command when
/// talk resumes**: the first word after any gap is STOP, and one that tripped the watchdog is trouble.
///
/// Arming proof, before the first command and after every return: a new connection (SYNC), ramps and tops set; then
/// type, cycle, watchdog, ticks, ramps and tops are read back and compared. It must report as often as stated, stand,
/// and have neither its stop button pressed nor a stall. That the watchdog acts is not shown. Odometry is its
/// encoders', or the wheels' speeds where none are reported.
class ArcosBase final : public MotorPair {
 public:
  /// `bus`, a place on the board's line, and `clock` outlive it. Throws StartupError where the setup cannot be.
  ArcosBase(CanBus& bus, Clock& clock, const BaseSetup& setup);
  void command(const WheelCommand& command) noexcept override;
  void disarm() noexcept override;

 private:
  /// What the board shows of a setting, and what it must.
  struct Compared {
    const char* name;
    int least, most, shown;
    const char* remedy;
    [[nodiscard]] bool is_well() const noexcept { return shown >= least && shown <= most; }
  };

  void take(const ReceivedFrame& received) noexcept override;
  void take_body(wire::Bytes body, Time stamp) noexcept;
  void take_report(const Report& report, Time stamp) noexcept;
  void take_encoders(const Encoders& counts, Time stamp) noexcept;
  void send_order(std::size_t index, MotorOrder order, double speed_radps) noexcept override;
  /// Its motors follow no speeds any more, by an order or because its watchdog tripped.
  void leave_operation() noexcept;
  [[nodiscard]] Duration watchdog() const noexcept;
  void say_orders() noexcept;
  [[nodiscard]] std::optional<Word> word_for(MotorOrder order) noexcept;
  void say(const Word& word) noexcept;

  void wake(bool anew) noexcept override;
  [[nodiscard]] bool recite(std::size_t end) noexcept;
  /// Axis 0: what it is set to. Axis 1: what it shows.
  void begin_proof(std::size_t index) noexcept override {
    if (index == 1) shown_.begin(clock().now());
  }
  ProofResult continue_proof(std::size_t index) noexcept override;
  [[nodiscard]] ProofResult judge_settings() const noexcept;
  [[nodiscard]] std::array<Compared, 9> compared() const noexcept;
  [[nodiscard]] std::string proof_line(std::size_t index) const override;
  [[nodiscard]] std::string proof_remedy(std::size_t index) const override;
  [[nodiscard]] StartupError absence(std::size_t index) const override;
  [[nodiscard]] bool is_open() const noexcept;
  [[nodiscard]] bool is_pioneer() const noexcept {
    return settings_ && std::string_view(settings_->type.data()) == "Pioneer";
  }

  CanBus& bus_;
  BaseSetup setup_;
  std::array<Word, 17> script_;  ///< of a connection
  std::size_t at_ = 0;           ///< the next word of it
  bool awaits_echo_ = false;     ///< of the SYNC said last
  PacketReader reader_;
  std::optional<Settings> settings_;
  ShownReports shown_;
  std::optional<Encoders> counts_;
  std::uint32_t faults_ = 0;
  bool motors_on_ = false;
  std::array<MotorOrder, 2> orders_{};
  std::array<double, 2> wanted_radps_{};
  int ordered_ = 0;  ///< motors, in this cycle
  Word said_;
  Time sent_ = kNever, enabled_ = kNever;
  double told_mmps_ = 0.0, told_turn_dps_ = 0.0;
};

/// The frames that tell the board to stop.
[[nodiscard]] std::vector<CanFrame> stop_frames();

}  // namespace jaywalk::arcos
