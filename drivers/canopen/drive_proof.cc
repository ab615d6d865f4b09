#include "drivers/canopen/drive_proof.h"

namespace jaywalk::canopen {
namespace {

/// It answers well, and otherwise than the one of the first proof.
bool is_another(const ProofLine& failed) noexcept {
  return failed.verdict == ProofVerdict::kProved || failed.verdict == ProofVerdict::kLacks;
}

}  // namespace

const char* remedy_for(const ProofLine& line) noexcept {
  if (line.verdict == ProofVerdict::kSilent) return kSilentDrive;
  if (line.item.demand == ProofDemand::kAtMost) return "see why its wheel turns";
  if (line.item.needed_to_drive) return "use a drive that can be set so: it cannot be driven otherwise";
  return "use a drive that can prove it, or allow_unproved at your own risk";
}

bool may_be_allowed(const ProofLine& line) noexcept {
  return line.verdict != ProofVerdict::kSilent && !line.item.needed_to_drive;
}

void DriveProof::begin(Time now) noexcept {
  asked_.emplace(bus_, node_, whole_proof(node_, setup_.settings), setup_.answer_timeout);
  state_ = State::kAsking;
  started_ = kNever;
  // A frame that is not taken shows in what follows.
  static_cast<void>(bus_.send(nmt_frame(NmtCommand::kPreOperational, node_)));
  asked_->poll(now);
}

void DriveProof::on_frame(const ReceivedFrame& received) noexcept {
  if (state_ == State::kAsking) return asked_->on_frame(received.frame, received.stamp);
  const auto heartbeat = decode_heartbeat(received.frame);
  if (!heartbeat || heartbeat->node != node_) return;
  const bool is_operational = heartbeat->state == NmtState::kOperational;
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
  } else if (state_ == State::kStarting && now - started_ > setup_.starting) {
    state_ = State::kFailed;
  }
}

void DriveProof::conclude_asking(Time now) noexcept {
  state_ = State::kFailed;
  for (std::size_t k = 0; k < asked_->lines().size(); ++k) {
    if (!is_good(k)) return;
  }
  if (bus_.send(nmt_frame(NmtCommand::kStart, node_)) != SendResult::kQueued) return;
  state_ = State::kStarting;
  started_ = now;
}

bool DriveProof::is_good(std::size_t line) const noexcept {
  const ProofLine& now = asked_->lines()[line];
  const ProofLine* const before = passed_first_ ? &(*passed_first_)[line] : nullptr;
  if (now.item.demand == ProofDemand::kKnown) {
    const bool is_same = before == nullptr || (before->verdict == now.verdict && before->said == now.said);
    return is_same && (now.verdict == ProofVerdict::kProved || now.verdict == ProofVerdict::kLacks);
  }
  if (now.verdict == ProofVerdict::kProved) return true;
  const bool never_was = before == nullptr || before->verdict != ProofVerdict::kProved;
  return setup_.allow_unproved && never_was && may_be_allowed(now);
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
