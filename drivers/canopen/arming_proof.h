#pragma once
#include <cstdint>
#include <string>

#include "drivers/canopen/pdo.h"
#include "drivers/canopen/sdo_client.h"

namespace jaywalk::canopen {

/// What an object is to show.
enum class ProofDemand : std::uint8_t {
  kWritten,     ///< the wanted value is written and read back
  kIdentifier,  ///< likewise, a COB-ID: its bit 30 (no remote frames) is the drive's own, and written where it is
                ///< refused
  kHeld,        ///< the drive keeps it itself: it is read, and is the wanted value
  kAtMost,      ///< it is read; a signed number of four bytes, within plus and minus the wanted value
  kKnown        ///< it is read, to be remembered: any value, or that the drive has no such object
};

/// One setting that a drive must be shown to have before it may move.
struct ProofItem {
  ObjectWrite wanted;
  ProofDemand demand = ProofDemand::kWritten;
  const char* what_for = "";
  bool needed_to_drive = false;  ///< also where stopping need not be proved
};

enum class ProofVerdict : std::uint8_t {
  kOpen,
  kProved,
  kDiffers,  ///< it took the value and reads another
  kRefused,  ///< it aborted; the code says why
  kLacks,    ///< of what is to be known only: the drive has no such object
  kSilent    ///< no answer, or the bus took no frame
};

struct ProofLine {
  ProofItem item;
  ProofVerdict verdict = ProofVerdict::kOpen;
  std::uint32_t said = 0;  ///< the value read, or the abort code
};

/// Writes settings to one drive and reads each back; goes on after a failure, so that all is known. What a drive says
/// is read-only is proved where it holds the value that was wanted.
///
/// Never waits: call on_frame with every frame and poll until done().
class ArmingProof {
 public:
  using Items = FixedVector<ProofItem, 64>;
  using Lines = FixedVector<ProofLine, 64>;

  /// `bus` outlives the proof.
  ArmingProof(CanBus& bus, std::uint8_t node, const Items& items, Duration timeout) noexcept;

  void on_frame(const CanFrame& frame, Time now) noexcept { client_.on_frame(frame, now); }
  void poll(Time now) noexcept;
  [[nodiscard]] bool done() const noexcept { return at_ == lines_.size(); }
  [[nodiscard]] const Lines& lines() const noexcept { return lines_; }

 private:
  enum class Step : std::uint8_t { kStart, kWriting, kReading };

  void begin_write(Time now) noexcept;
  void begin_read(Time now) noexcept;
  /// The value that was read, cut to the item's bytes.
  [[nodiscard]] std::uint32_t said() const noexcept;
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

}  // namespace jaywalk::canopen
