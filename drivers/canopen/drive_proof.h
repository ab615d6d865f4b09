#pragma once
// The settings of a CiA 402 drive, and the proof that it has them.
#include <optional>
#include <string>
#include <vector>

#include "drivers/canopen/arming_proof.h"
#include "drivers/canopen/pdo.h"

namespace jaywalk::canopen {

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

/// Receive PDO 1 of `node`: controlword and target velocity.
[[nodiscard]] PdoSetup command_pdo(std::uint8_t node) noexcept;
/// Transmit PDO 1: statusword, velocity and the mode shown. Both PDOs go at every SYNC.
[[nodiscard]] PdoSetup status_pdo(std::uint8_t node) noexcept;
/// Transmit PDO 2: position.
[[nodiscard]] PdoSetup position_pdo(std::uint8_t node) noexcept;

/// How the drive is to behave: heartbeats, what happens when they fail, ramps, mode.
[[nodiscard]] ArmingProof::Items behaviour_items(const DriveSettings& settings) noexcept;
/// These, and the PDOs, which are switched off, mapped and switched on.
[[nodiscard]] ArmingProof::Items proof_items(std::uint8_t node, const DriveSettings& settings) noexcept;

/// All that a drive must show before it may turn a wheel: these, that it stands, and its identity (1018h), by which
/// another drive with the same number is told when it is proved again.
[[nodiscard]] ArmingProof::Items whole_proof(std::uint8_t node, const DriveSettings& settings) noexcept;

/// What tells a CiA 402 drive: its device type (1000h), and its modes (6502h), to be read alone.
[[nodiscard]] ArmingProof::Items identity_items() noexcept;
/// Of the answers to these.
[[nodiscard]] bool speaks_profile_velocity(const ArmingProof::Lines& identity) noexcept;

/// Remedy for a drive that does not answer, or no longer.
inline constexpr const char* kSilentDrive = "see to its cable, its power, its node number and the bus's bit rate";
/// Remedy for a line that is not proved.
[[nodiscard]] const char* remedy_for(const ProofLine& line) noexcept;
/// True where allow_unproved may arm the drive: the line is about stopping, and the drive answered that it cannot.
[[nodiscard]] bool may_be_allowed(const ProofLine& line) noexcept;

struct DriveProofSetup {
  DriveSettings settings;
  Duration answer_timeout{0};   ///< of one transfer
  Duration starting{0};         ///< from NMT start until a heartbeat says "operational"
  bool allow_unproved = false;  ///< what the drive could not prove the first time it need not prove later
};

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

  /// `bus` outlives it; `node` is 1 to 127.
  DriveProof(CanBus& bus, std::uint8_t node, const DriveProofSetup& setup) noexcept
      : bus_(bus), node_(node), setup_(setup) {}

  void begin(Time now) noexcept;
  void on_frame(const ReceivedFrame& received) noexcept;
  void poll(Time now) noexcept;

  [[nodiscard]] State state() const noexcept { return state_; }
  /// Of the heartbeat that ended it.
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
  DriveProofSetup setup_;
  State state_ = State::kIdle;
  std::optional<ArmingProof> asked_;
  std::optional<ArmingProof::Lines> passed_first_;
  Time started_ = kNever, heard_ = kNever;
};

}  // namespace jaywalk::canopen
