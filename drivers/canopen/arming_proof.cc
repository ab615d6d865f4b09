#include "drivers/canopen/arming_proof.h"

#include <algorithm>
#include <array>
#include <cstdio>

#include "drivers/canopen/sdo_abort.h"

namespace jaywalk::canopen {

namespace {

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

bool ArmingProof::proved() const noexcept {
  return std::all_of(lines_.begin(), lines_.end(),
                     [](const ProofLine& l) { return l.verdict == ProofVerdict::kProved; });
}

void ArmingProof::poll(Time now) noexcept {
  client_.poll(now);
  if (done() || client_.status() == SdoStatus::kBusy) return;
  const ProofItem& item = lines_[at_].item;
  switch (step_) {
    case Step::kStart: {
      if (!item.write) return begin_read(now);
      std::array<std::uint8_t, 4> bytes{};
      wire::put_little_endian(item.wanted.value, bytes);
      step_ = Step::kWriting;
      const auto count = std::min<std::size_t>(item.wanted.bytes, bytes.size());
      if (!client_.write(item.wanted.address, wire::Bytes(bytes).first(count), now)) conclude(ProofVerdict::kSilent, 0);
      return;
    }
    case Step::kWriting:
      read_only_ = client_.status() == SdoStatus::kAbortedByDrive && client_.abort_code() == kAbortReadOnly;
      if (read_only_ || !conclude_failure()) begin_read(now);
      return;
    case Step::kReading:
      if (!conclude_failure()) conclude_read();
      return;
  }
}

void ArmingProof::begin_read(Time now) noexcept {
  step_ = Step::kReading;
  if (!client_.read(lines_[at_].item.wanted.address, now)) conclude(ProofVerdict::kSilent, 0);
}

void ArmingProof::conclude_read() noexcept {
  const ObjectWrite& wanted = lines_[at_].item.wanted;
  std::array<std::uint8_t, 4> padded{};
  const auto value = client_.value();
  std::copy_n(value.begin(), std::min(value.size(), padded.size()), padded.begin());
  const std::uint32_t said = cut(wire::little_endian<std::uint32_t>(padded), wanted.bytes);
  const bool same = value.size() >= wanted.bytes && said == cut(wanted.value, wanted.bytes);
  if (read_only_ && !same) return conclude(ProofVerdict::kRefused, kAbortReadOnly);
  conclude(same ? ProofVerdict::kProved : ProofVerdict::kDiffers, said);
}

bool ArmingProof::conclude_failure() noexcept {
  if (client_.status() == SdoStatus::kDone) return false;
  const bool refused = client_.status() == SdoStatus::kAbortedByDrive;
  conclude(refused ? ProofVerdict::kRefused : ProofVerdict::kSilent, client_.abort_code());
  return true;
}

void ArmingProof::conclude(ProofVerdict verdict, std::uint32_t said) noexcept {
  lines_[at_].verdict = verdict;
  lines_[at_].said = said;
  ++at_;
  step_ = Step::kStart;
  read_only_ = false;
}

std::string describe(const ProofLine& line) {
  const ObjectWrite& wanted = line.item.wanted;
  const auto hex = [](std::uint32_t number, int digits) {
    std::array<char, 16> text{};
    std::snprintf(text.data(), text.size(), "%0*Xh", digits, static_cast<unsigned>(number));
    return std::string(text.data());
  };
  const std::string what = hex(wanted.address.index, 4) + ":" + std::to_string(wanted.address.sub) + " " +
                           line.item.what_for + ": wanted " + hex(cut(wanted.value, wanted.bytes), 2 * wanted.bytes);
  switch (line.verdict) {
    case ProofVerdict::kProved:
      return what + ", reads the same";
    case ProofVerdict::kDiffers:
      return what + ", reads " + hex(line.said, 2 * wanted.bytes) + ": NOT PROVED";
    case ProofVerdict::kRefused:
      return what + ", refused (" + std::string(abort_name(line.said)) + "): NOT PROVED";
    case ProofVerdict::kSilent:
      return what + ", no answer: NOT PROVED";
    case ProofVerdict::kOpen:
      break;
  }
  return what + ", not asked yet";
}

}  // namespace jaywalk::canopen
