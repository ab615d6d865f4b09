#include "drivers/canopen/arming_proof.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>

namespace jaywalk::canopen {
namespace {

constexpr std::uint32_t kNoRemoteFrames = 1U << 30U;  ///< bit of a COB-ID (CiA 301)

/// The low bytes of `value` that the object has.
std::uint32_t cut(std::uint32_t value, std::uint8_t bytes) noexcept {
  return bytes >= 4 ? value : value & ((1U << (8U * bytes)) - 1U);
}

}  // namespace

ArmingProof::ArmingProof(CanBus& bus, std::uint8_t node, const Items& items, Duration timeout) noexcept
    : client_(bus, node, timeout) {
  static_assert(Items::capacity() == Lines::capacity());
  for (const ProofItem& item : items) static_cast<void>(lines_.push_back({item, ProofVerdict::kOpen, 0}));
}

void ArmingProof::poll(Time now) noexcept {
  client_.poll(now);
  if (done() || client_.status() == SdoStatus::kBusy) return;
  const ProofItem& item = lines_[at_].item;
  switch (step_) {
    case Step::kStart:
      own_bits_ = 0;
      return item.demand == ProofDemand::kWritten || item.demand == ProofDemand::kIdentifier ? begin_write(now)
                                                                                             : begin_read(now);
    case Step::kWriting: {
      const bool refused = client_.status() == SdoStatus::kAbortedByDrive;
      if (refused && item.demand == ProofDemand::kIdentifier && own_bits_ == 0) {
        own_bits_ = kNoRemoteFrames;
        return begin_write(now);
      }
      read_only_ = refused && client_.abort_code() == kAbortReadOnly;
      if (read_only_ || !conclude_failure()) begin_read(now);
      return;
    }
    case Step::kReading:
      if (!conclude_failure()) conclude_read();
      return;
  }
}

void ArmingProof::begin_write(Time now) noexcept {
  const ObjectWrite& wanted = lines_[at_].item.wanted;
  std::array<std::uint8_t, 4> bytes{};
  wire::put_little_endian(wanted.value | own_bits_, bytes);
  step_ = Step::kWriting;
  const auto count = std::min<std::size_t>(wanted.bytes, bytes.size());
  if (!client_.write(wanted.address, wire::Bytes(bytes).first(count), now)) conclude(ProofVerdict::kSilent, 0);
}

void ArmingProof::begin_read(Time now) noexcept {
  step_ = Step::kReading;
  if (!client_.read(lines_[at_].item.wanted.address, now)) conclude(ProofVerdict::kSilent, 0);
}

std::uint32_t ArmingProof::said() const noexcept {
  std::array<std::uint8_t, 4> padded{};
  const auto value = client_.value();
  std::copy_n(value.begin(), std::min(value.size(), padded.size()), padded.begin());
  return cut(wire::little_endian<std::uint32_t>(padded), lines_[at_].item.wanted.bytes);
}

void ArmingProof::conclude_read() noexcept {
  const ProofVerdict verdict = verdict_of(said(), client_.value().size() >= lines_[at_].item.wanted.bytes);
  if (read_only_ && verdict != ProofVerdict::kProved) return conclude(ProofVerdict::kRefused, kAbortReadOnly);
  conclude(verdict, said());
}

ProofVerdict ArmingProof::verdict_of(std::uint32_t said, bool has_all) const noexcept {
  const ProofItem& item = lines_[at_].item;
  bool is_so = said == cut(item.wanted.value, item.wanted.bytes);
  if (item.demand == ProofDemand::kAtMost)
    is_so = std::llabs(static_cast<std::int32_t>(said)) <= static_cast<std::int64_t>(item.wanted.value);
  if (item.demand == ProofDemand::kIdentifier) is_so = (said & ~kNoRemoteFrames) == item.wanted.value;
  if (item.demand == ProofDemand::kKnown) is_so = true;
  return has_all && is_so ? ProofVerdict::kProved : ProofVerdict::kDiffers;
}

bool ArmingProof::conclude_failure() noexcept {
  if (client_.status() == SdoStatus::kDone) return false;
  const bool refused = client_.status() == SdoStatus::kAbortedByDrive;
  const bool lacks = refused && lines_[at_].item.demand == ProofDemand::kKnown;
  conclude(lacks     ? ProofVerdict::kLacks
           : refused ? ProofVerdict::kRefused
                     : ProofVerdict::kSilent,
           client_.abort_code());
  return true;
}

void ArmingProof::conclude(ProofVerdict verdict, std::uint32_t said) noexcept {
  lines_[at_].verdict = verdict;
  lines_[at_].said = said;
  ++at_;
  step_ = Step::kStart;
  read_only_ = false;
}

namespace {

std::string hex(std::uint32_t number, int digits) {
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), "%0*Xh", digits, static_cast<unsigned>(number));
  return text.data();
}

std::string name_of(const ProofItem& item) {
  const ObjectAddress& address = item.wanted.address;
  return hex(address.index, 4) + ":" + std::to_string(address.sub) + " " + item.what_for;
}

/// What was wanted of it.
std::string demand_of(const ProofItem& item) {
  const std::string value = hex(cut(item.wanted.value, item.wanted.bytes), 2 * item.wanted.bytes);
  if (item.demand == ProofDemand::kKnown) return "";
  return (item.demand == ProofDemand::kAtMost ? ": at most " : ": wanted ") + value;
}

}  // namespace

std::string describe(const ProofLine& line) {
  const std::string what = name_of(line.item) + demand_of(line.item);
  const std::string said = hex(line.said, 2 * line.item.wanted.bytes);
  switch (line.verdict) {
    case ProofVerdict::kProved:
      return what + (demand_of(line.item) == ": wanted " + said ? ", reads the same" : ", reads " + said);
    case ProofVerdict::kDiffers: return what + ", reads " + said + ": NOT PROVED";
    case ProofVerdict::kRefused: return what + ", refused (" + std::string(abort_name(line.said)) + "): NOT PROVED";
    case ProofVerdict::kLacks: return what + ", none (" + std::string(abort_name(line.said)) + ")";
    case ProofVerdict::kSilent: return what + ", no answer: NOT PROVED";
    case ProofVerdict::kOpen: break;
  }
  return what + ", not asked yet";
}

}  // namespace jaywalk::canopen
