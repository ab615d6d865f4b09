#pragma once
#include <cstdint>
#include <string>

#include "drivers/canopen/pdo.h"
#include "drivers/canopen/sdo_client.h"

namespace jaywalk::canopen {

/// One setting that a drive must be shown to have before it may move.
struct ProofItem {
  ObjectWrite wanted;
  bool write = true;  ///< false: the drive keeps it itself, it is only read
  const char* what_for = "";
};

enum class ProofVerdict : std::uint8_t {
  kOpen,
  kProved,
  kDiffers,  ///< it took the value and reads another
  kRefused,  ///< it aborted; the code says why
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
  [[nodiscard]] bool proved() const noexcept;
  [[nodiscard]] const Lines& lines() const noexcept { return lines_; }

 private:
  enum class Step : std::uint8_t { kStart, kWriting, kReading };

  void begin_read(Time now) noexcept;
  void conclude_read() noexcept;
  void conclude(ProofVerdict verdict, std::uint32_t said) noexcept;
  /// True, and the item concluded, where the transfer failed.
  bool conclude_failure() noexcept;

  SdoClient client_;
  Lines lines_;
  std::size_t at_ = 0;
  Step step_ = Step::kStart;
  bool read_only_ = false;  ///< the drive said so of this item
};

/// "1016h:1 watching the controller's heartbeat: wanted 00010064h, reads 00000000h: NOT PROVED". Not for the loop.
[[nodiscard]] std::string describe(const ProofLine& line);

}  // namespace jaywalk::canopen
