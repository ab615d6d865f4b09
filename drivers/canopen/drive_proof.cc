#include "drivers/canopen/drive_proof.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <initializer_list>

#include "hal/shown_text.h"

namespace jaywalk::canopen {
namespace {

constexpr Duration kStarting = std::chrono::milliseconds(500);  ///< from NMT start until a drive says "operational"
constexpr std::uint32_t kNoRemoteFrames = 1U << 30U;            ///< bit of a COB-ID (CiA 301)

std::string hex(std::uint32_t number, int digits) { return formatted("%0*Xh", digits, static_cast<unsigned>(number)); }

std::string name_of(const ProofLine& item) {
  const ObjectAddress& address = item.wanted.address;
  return hex(address.index, 4) + ":" + std::to_string(address.sub) + " " + item.what_for;
}

/// What was wanted of it.
std::string demand_of(const ProofLine& item) {
  const std::string value = hex(cut(item.wanted.value, item.wanted.bytes), 2 * item.wanted.bytes);
  if (item.demand == ProofDemand::kKnown) return "";
  return (item.demand == ProofDemand::kAtMost ? ": at most " : ": wanted ") + value;
}

constexpr std::uint8_t kAtEverySync = 1;
constexpr std::uint32_t kHasProfileVelocity = 1U << 2U;

// Option codes of CiA 402: 6007h 3 is quick stop; 605Ah 2 brakes by 6085h, then switches off; 605Bh, 605Ch and 605Dh 1
// brake by 6084h; 605Eh 2 brakes by 6085h.
constexpr std::uint32_t kLostControllerQuickStops = 3, kQuickStopThenOff = 2, kBrakeThenOff = 1, kBrake = 1,
                        kFaultQuickStops = 2;

void add(ArmingProof::Lines& items, const ProofLine& item) noexcept {
  const bool fits = items.push_back(item);
  assert(fits);
  static_cast<void>(fits);
}

/// One object inside a PDO; whole bytes only, 1 to 4 of them.
struct MappedObject {
  ObjectAddress address;
  std::uint8_t bytes = 0;
};

/// Settings of receive PDO n live at 1400h + n - 1 and 1600h + n - 1, of transmit PDO n at 1800h and 1A00h. CiA 301: a
/// PDO must be off (bit 31 of its COB-ID) and its mapping empty while it is mapped.
void add_pdo(ArmingProof::Lines& items, std::uint16_t communication, std::uint32_t id,
             std::initializer_list<MappedObject> objects) noexcept {
  constexpr std::uint32_t kOff = 0x80000000;
  const auto mapping = static_cast<std::uint16_t>(communication + 0x200);
  const auto write = [&items](ObjectWrite wanted, ProofDemand demand = ProofDemand::kWritten) {
    add(items, {wanted, demand, "process data", true});
  };
  write({{communication, 1}, id | kOff, 4}, ProofDemand::kIdentifier);
  write({{mapping, 0}, 0, 1});
  std::uint8_t entry = 0;
  for (const auto& [address, bytes] : objects)  // index, sub-index, length in bits
    write({{mapping, ++entry}, std::uint32_t{address.index} << 16U | std::uint32_t{address.sub} << 8U | 8U * bytes, 4});
  write({{mapping, 0}, entry, 1});
  write({{communication, 2}, kAtEverySync, 1});
  write({{communication, 1}, id, 4}, ProofDemand::kIdentifier);
}

/// It answers well, and otherwise than the one of the first proof.
bool is_another(const ProofLine& failed) noexcept {
  return failed.verdict == ProofVerdict::kProved || failed.verdict == ProofVerdict::kLacks;
}

}  // namespace

void ArmingProof::poll(Time now) noexcept {
  client_.poll(now);
  if (done() || client_.status() == SdoStatus::kBusy) return;
  const ProofLine& item = lines_[at_];
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
  ObjectWrite wanted = lines_[at_].wanted;
  wanted.value |= own_bits_;
  step_ = Step::kWriting;
  if (!client_.write(wanted, now)) conclude(ProofVerdict::kSilent, 0);
}

void ArmingProof::begin_read(Time now) noexcept {
  step_ = Step::kReading;
  if (!client_.read(lines_[at_].wanted.address, now)) conclude(ProofVerdict::kSilent, 0);
}

void ArmingProof::conclude_read() noexcept {
  std::array<std::uint8_t, 4> padded{};
  const wire::Bytes value = client_.value();
  std::copy_n(value.begin(), std::min(value.size(), padded.size()), padded.begin());
  const std::uint8_t bytes = lines_[at_].wanted.bytes;
  const std::uint32_t said = cut(wire::little_endian<std::uint32_t>(padded), bytes);
  const ProofVerdict verdict = verdict_of(said, value.size() >= bytes);
  if (read_only_ && verdict != ProofVerdict::kProved) return conclude(ProofVerdict::kRefused, kAbortReadOnly);
  conclude(verdict, said);
}

ProofVerdict ArmingProof::verdict_of(std::uint32_t said, bool has_all) const noexcept {
  const ProofLine& item = lines_[at_];
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
  const bool lacks = refused && lines_[at_].demand == ProofDemand::kKnown;
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

std::string describe(const ProofLine& line) {
  const std::string what = name_of(line) + demand_of(line);
  const std::string said = hex(line.said, 2 * line.wanted.bytes);
  switch (line.verdict) {
    case ProofVerdict::kProved:
      return what + (demand_of(line) == ": wanted " + said ? ", reads the same" : ", reads " + said);
    case ProofVerdict::kDiffers: return what + ", reads " + said + ": NOT PROVED";
    case ProofVerdict::kRefused: return what + ", refused (" + std::string(abort_name(line.said)) + "): NOT PROVED";
    case ProofVerdict::kLacks: return what + ", none (" + std::string(abort_name(line.said)) + ")";
    case ProofVerdict::kSilent: return what + ", no answer: NOT PROVED";
    case ProofVerdict::kOpen: break;
  }
  return what + ", not asked yet";
}

// Its mode shows in 6061h once it is enabled, of many drives no sooner: WheelAxis holds it against the drive then.
ArmingProof::Lines behaviour_items(const DriveSettings& settings) noexcept {
  const std::uint32_t watch = heartbeat_consumer_entry(settings.controller_node, settings.controller_timeout_ms);
  ArmingProof::Lines items;
  const auto need = [&items](ObjectWrite wanted, const char* what_for, bool to_drive = false) {
    add(items, {wanted, ProofDemand::kWritten, what_for, to_drive});
  };
  need({{0x1016, 1}, watch, 4}, "watches the controller's heartbeat");
  need({{0x1017, 0}, settings.heartbeat_ms, 2}, "says its own heartbeat", true);
  need({kAbortConnection, kLostControllerQuickStops, 2}, "stops when the controller is lost");
  need({kQuickStopOption, kQuickStopThenOff, 2}, "quick stop");
  need({kShutdownOption, kBrakeThenOff, 2}, "brakes at shutdown");
  need({kDisableOption, kBrakeThenOff, 2}, "brakes when disabled");
  need({kHaltOption, kBrake, 2}, "brakes at halt");
  need({kFaultOption, kFaultQuickStops, 2}, "brakes at a fault");
  need({kProfileAcceleration, settings.acceleration, 4}, "acceleration");
  need({kProfileDeceleration, settings.deceleration, 4}, "deceleration");
  need({kQuickStopDeceleration, settings.quick_stop, 4}, "quick stop deceleration");
  need({kModeWanted, kProfileVelocityMode, 1}, "profile velocity", true);
  return items;
}

ArmingProof::Lines proof_items(std::uint8_t node, const DriveSettings& settings) noexcept {
  ArmingProof::Lines items = behaviour_items(settings);
  add_pdo(items, 0x1400, 0x200U + node, {{kControlword, 2}, {kTargetVelocity, 4}});
  add_pdo(items, 0x1800, 0x180U + node, {{kStatusword, 2}, {kVelocity, 4}, {kModeShown, 1}});
  add_pdo(items, 0x1801, 0x280U + node, {{kPosition, 4}});
  return items;
}

ArmingProof::Lines whole_proof(std::uint8_t node, const DriveSettings& settings) noexcept {
  ArmingProof::Lines items = proof_items(node, settings);
  add(items, {{kVelocity, settings.standstill, 4}, ProofDemand::kAtMost, "stands", true});
  constexpr std::array kIdentity{"vendor", "product code", "revision", "serial number"};
  for (std::uint8_t sub = 1; sub <= kIdentity.size(); ++sub)
    add(items, {{{0x1018, sub}, 0, 4}, ProofDemand::kKnown, kIdentity[sub - 1U]});
  return items;
}

// CiA 301: the low 16 bits of 1000h name the device's profile. CiA 402: bit 2 of 6502h is profile velocity.
ArmingProof::Lines identity_items() noexcept {
  ArmingProof::Lines items;
  add(items, {{{0x1000, 0}, 402, 2}, ProofDemand::kHeld, "device type"});
  add(items, {{{0x6502, 0}, kHasProfileVelocity, 4}, ProofDemand::kHeld, "modes"});
  return items;
}

bool speaks_profile_velocity(const ArmingProof::Lines& identity) noexcept {
  const auto was_read = [](const ProofLine& line) {
    return line.verdict == ProofVerdict::kProved || line.verdict == ProofVerdict::kDiffers;
  };
  return identity.size() == 2 && identity[0].verdict == ProofVerdict::kProved && was_read(identity[1]) &&
         (identity[1].said & kHasProfileVelocity) != 0;
}

const char* remedy_for(const ProofLine& line) noexcept {
  if (line.verdict == ProofVerdict::kSilent) return kSilentDrive;
  if (line.demand == ProofDemand::kAtMost) return "see why its wheel turns";
  if (line.needed_to_drive) return "use a drive that can be set so: it cannot be driven otherwise";
  return "use a drive that can prove it, or allow_unproved at your own risk";
}

bool may_be_allowed(const ProofLine& line) noexcept {
  return line.verdict != ProofVerdict::kSilent && !line.needed_to_drive;
}

void DriveProof::begin(Time now) noexcept {
  asked_.emplace(bus_, node_, whole_proof(node_, settings_));
  state_ = State::kAsking;
  started_ = kNever;
  // A frame that is not taken shows in what follows.
  static_cast<void>(bus_.send(nmt_frame(NmtCommand::kPreOperational, node_)));
  asked_->poll(now);
}

void DriveProof::on_frame(const ReceivedFrame& received) noexcept {
  if (state_ == State::kAsking) return asked_->on_frame(received.frame, received.stamp);
  const auto network = heartbeat_in(received.frame, node_);
  if (!network) return;
  const bool is_operational = network == NmtState::kOperational;
  if (state_ == State::kStarting && is_operational && received.stamp >= started_) {
    state_ = State::kPassed;
    heard_ = received.stamp;
    if (!passed_first_) passed_first_ = asked_->lines();
  } else if (state_ == State::kPassed && !is_operational) {
    state_ = State::kFailed;
  } else if (state_ == State::kPassed) {
    heard_ = received.stamp;
  }
}

void DriveProof::poll(Time now) noexcept {
  if (state_ == State::kAsking) {
    asked_->poll(now);
    if (asked_->done()) conclude_asking(now);
  } else if (state_ == State::kStarting && now - started_ > kStarting) {
    state_ = State::kFailed;
  }
}

void DriveProof::conclude_asking(Time now) noexcept {
  state_ = State::kFailed;
  for (std::size_t k = 0; k < asked_->lines().size(); ++k)
    if (!is_good(k)) return;
  if (!bus_.send(nmt_frame(NmtCommand::kStart, node_))) return;
  state_ = State::kStarting;
  started_ = now;
}

bool DriveProof::is_good(std::size_t line) const noexcept {
  const ProofLine& now = asked_->lines()[line];
  const ProofLine* const before = passed_first_ ? &(*passed_first_)[line] : nullptr;
  if (now.demand == ProofDemand::kKnown) {
    const bool is_same = before == nullptr || (before->verdict == now.verdict && before->said == now.said);
    return is_same && (now.verdict == ProofVerdict::kProved || now.verdict == ProofVerdict::kLacks);
  }
  if (now.verdict == ProofVerdict::kProved) return true;
  const bool never_was = before == nullptr || before->verdict != ProofVerdict::kProved;
  return allow_unproved_ && never_was && may_be_allowed(now);
}

std::vector<std::string> DriveProof::report() const {
  std::vector<std::string> lines;
  if (!asked_) return lines;
  for (const ProofLine& line : asked_->lines())
    lines.push_back("node " + std::to_string(node_) + ": " + describe(line));
  return lines;
}

std::string DriveProof::failure() const {
  const std::string drive = "node " + std::to_string(node_) + ": ";
  const ProofLine* const line = failed_line();
  if (line == nullptr) return drive + "no heartbeat that says it is operational";
  return drive + describe(*line) + (is_another(*line) ? ", another drive than before: NOT PROVED" : "");
}

std::string DriveProof::remedy() const {
  const ProofLine* const line = failed_line();
  if (line == nullptr) return kSilentDrive;
  if (is_another(*line)) return "start the run anew, and commission the robot if the drive was exchanged";
  return remedy_for(*line);
}

const ProofLine* DriveProof::failed_line() const noexcept {
  for (std::size_t k = 0; asked_ && k < asked_->lines().size(); ++k)
    if (!is_good(k)) return &asked_->lines()[k];
  return nullptr;
}

}  // namespace jaywalk::canopen
