#pragma once
#include <optional>
#include <string>
#include <vector>

#include "drivers/canopen/arming_proof.h"
#include "drivers/canopen/drive_settings.h"
#include "drivers/canopen/services.h"

namespace jaywalk::canopen {

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
