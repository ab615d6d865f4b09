#pragma once
// The settings of a CiA 402 drive, and the proof that it has them.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "drivers/canopen/cia402.h"
#include "drivers/canopen/sdo_client.h"

namespace jaywalk::canopen {

/// Longest time of one transfer while arming.
inline constexpr Duration kAnswerTimeout = std::chrono::milliseconds(100);

/// What an object is to show.
enum class ProofDemand : std::uint8_t {
  kWritten,     ///< the wanted value is written and read back
  kIdentifier,  ///< likewise, a COB-ID: its bit 30 (no remote frames) is the drive's own, and written where it is
                ///< refused
  kHeld,        ///< the drive keeps it itself: it is read, and is the wanted value
  kAtMost,      ///< it is read; a signed number of four bytes, within plus and minus the wanted value
  kKnown        ///< it is read, to be remembered: any value, or that the drive has no such object
};

enum class ProofVerdict : std::uint8_t {
  kOpen,
  kProved,
  kDiffers,  ///< it took the value and reads another
  kRefused,  ///< it aborted; the code says why
  kLacks,    ///< of what is to be known only: the drive has no such object
  kSilent    ///< no answer, or the bus took no frame
};

/// One setting that a drive must be shown to have before it may move, and what it showed.
struct ProofLine {
  ObjectWrite wanted;
  ProofDemand demand = ProofDemand::kWritten;
  const char* what_for = "";
  bool needed_to_drive = false;  ///< also where stopping need not be proved
  ProofVerdict verdict = ProofVerdict::kOpen;
  std::uint32_t said = 0;  ///< the value read, or the abort code
};

/// Writes settings to one drive and reads each back; goes on after a failure, so that all is known. What a drive says
/// is read-only is proved where it holds the value that was wanted.
///
/// Never waits: call on_frame with every frame and poll until done().
class ArmingProof {
 public:
  using Lines = FixedVector<ProofLine, 64>;

  /// `bus` outlives the proof.
  ArmingProof(CanBus& bus, std::uint8_t node, const Lines& lines) noexcept
      : client_(bus, node, kAnswerTimeout), lines_(lines) {}

  void on_frame(const CanFrame& frame, Time now) noexcept { client_.on_frame(frame, now); }
  void poll(Time now) noexcept;
  [[nodiscard]] bool done() const noexcept { return at_ == lines_.size(); }
  [[nodiscard]] const Lines& lines() const noexcept { return lines_; }

 private:
  enum class Step : std::uint8_t { kStart, kWriting, kReading };

  void begin_write(Time now) noexcept;
  void begin_read(Time now) noexcept;
  void conclude_read() noexcept;
  [[nodiscard]] ProofVerdict verdict_of(std::uint32_t said, bool has_all) const noexcept;
  void conclude(ProofVerdict verdict, std::uint32_t said) noexcept;
  /// True, and the item concluded, where the transfer failed.
  bool conclude_failure() noexcept;

  SdoClient client_;
  Lines lines_;
  std::size_t at_ = 0;
  Step step_ = Step::kStart;
  bool read_only_ = false;      ///< the drive said so of this item
  std::uint32_t own_bits_ = 0;  ///< of this item, as the drive wants them
};

/// "1016h:1 watching the controller's heartbeat: wanted 00010064h, reads 00000000h: NOT PROVED". Not for the loop.
[[nodiscard]] std::string describe(const ProofLine& line);

/// What one drive is to be told before it may move.
struct DriveSettings {
  std::uint8_t controller_node = 1;           ///< whose heartbeat it watches
  std::uint16_t controller_timeout_ms = 100;  ///< then it stops by itself
  std::uint16_t heartbeat_ms = 50;            ///< its own
  std::uint32_t acceleration = 0;             ///< 6083h, counts/s2
  std::uint32_t deceleration = 0;             ///< 6084h, counts/s2
  std::uint32_t quick_stop = 0;               ///< 6085h, counts/s2
  std::uint32_t standstill = 0;               ///< a wheel that says no more than this (counts/s) stands
};

/// How the drive is to behave: heartbeats, what happens when they fail, ramps, mode.
[[nodiscard]] ArmingProof::Lines behaviour_items(const DriveSettings& settings) noexcept;
/// These, and the PDOs, which are switched off, mapped and switched on. All go at every SYNC: receive PDO 1 with
/// controlword and target velocity, transmit PDO 1 with statusword, velocity and mode shown, transmit PDO 2 with
/// position.
[[nodiscard]] ArmingProof::Lines proof_items(std::uint8_t node, const DriveSettings& settings) noexcept;

/// All that a drive must show before it may turn a wheel: these, that it stands, and its identity (1018h), by which
/// another drive with the same number is told when it is proved again.
[[nodiscard]] ArmingProof::Lines whole_proof(std::uint8_t node, const DriveSettings& settings) noexcept;

/// What tells a CiA 402 drive: its device type (1000h), and its modes (6502h), to be read alone.
[[nodiscard]] ArmingProof::Lines identity_items() noexcept;
/// Of the answers to these.
[[nodiscard]] bool speaks_profile_velocity(const ArmingProof::Lines& identity) noexcept;

/// Remedy for a drive that does not answer, or no longer.
inline constexpr const char* kSilentDrive = "see to its cable, its power, its node number and the bus's bit rate";
/// Remedy for a line that is not proved.
[[nodiscard]] const char* remedy_for(const ProofLine& line) noexcept;
/// True where allow_unproved may arm the drive: the line is about stopping, and the drive answered that it cannot.
[[nodiscard]] bool may_be_allowed(const ProofLine& line) noexcept;

/// The whole proof of one drive, from whatever state it is in to Operational: NMT pre-operational, settings and process
/// data written and read back, standstill, identity, NMT start, and a heartbeat that says so (SAFETY 4, 15). At arming
/// and after every return it is the same.
///
/// The identity is remembered from the first proof that is passed; later another drive with the same node fails.
/// Never waits and never allocates: call on_frame with every frame, and poll. No heartbeat of the controller's is sent
/// meanwhile.
class DriveProof {
 public:
  enum class State : std::uint8_t { kIdle, kAsking, kStarting, kPassed, kFailed };

  /// `bus` outlives it; `node` is 1 to 127. `allow_unproved`: what the drive could not prove the first time it need not
  /// prove later.
  DriveProof(CanBus& bus, std::uint8_t node, const DriveSettings& settings, bool allow_unproved) noexcept
      : bus_(bus), node_(node), settings_(settings), allow_unproved_(allow_unproved) {}

  void begin(Time now) noexcept;
  void on_frame(const ReceivedFrame& received) noexcept;
  void poll(Time now) noexcept;

  [[nodiscard]] State state() const noexcept { return state_; }
  /// Time of the heartbeat that ended the proof.
  [[nodiscard]] Time heard() const noexcept { return heard_; }
  /// What the drive said so far, a line a setting. Not for the loop.
  [[nodiscard]] std::vector<std::string> report() const;
  /// Why it failed, and what to do. Not for the loop.
  [[nodiscard]] std::string failure() const;
  [[nodiscard]] std::string remedy() const;

 private:
  void conclude_asking(Time now) noexcept;
  [[nodiscard]] bool is_good(std::size_t line) const noexcept;
  /// The first that is not good; null: none.
  [[nodiscard]] const ProofLine* failed_line() const noexcept;

  CanBus& bus_;
  std::uint8_t node_;
  DriveSettings settings_;
  bool allow_unproved_;
  State state_ = State::kIdle;
  std::optional<ArmingProof> asked_;
  std::optional<ArmingProof::Lines> passed_first_;
  Time started_ = kNever, heard_ = kNever;
};

}  // namespace jaywalk::canopen
