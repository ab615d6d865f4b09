// MotorPair's arming proof, at start-up and after every return.
#include "drivers/motor/motor_pair.h"
#include "hal/shown_text.h"

namespace jaywalk {
namespace {

/// Another controller commands at 20 Hz or more: in this time it is heard several times.
constexpr Duration kListening = std::chrono::milliseconds(300);

std::string in_words(const CanFrame& frame) {
  std::string words = formatted(frame.extended ? "%08Xh" : "%03Xh", static_cast<unsigned>(frame.id));
  if (frame.remote) return words + " (a request)";
  for (const std::uint8_t byte : frame.payload()) words += formatted(" %02X", static_cast<unsigned>(byte));
  return words;
}

}  // namespace

std::vector<std::string> MotorPair::arm() {
  trouble_ = DriveTrouble::kNone;
  listen();
  begin_proofs();
  while (proving_ && !foreign_) {
    continue_proofs();
    pass_time();
  }
  std::vector<std::string> report = judge_proofs();
  armed_ = true;
  bus_watch_.begin(bus_.health());
  return report;
}

void MotorPair::listen() {
  foreign_.reset();
  for (const Time began = clock_.now(); clock_.now() - began < kListening && !foreign_;) pass_time();
}

std::vector<std::string> MotorPair::judge_proofs() const {
  if (foreign_) {
    throw StartupError("CAN: another program commands the drives: frame " + in_words(*foreign_),
                       "end that program, or take it off this bus; a frame of a drive's own came too often: give each "
                       "a number of its own, and an ODrive can.heartbeat_msg_rate_ms of 10 or more");
  }
  std::vector<std::string> report;
  for (std::size_t k = 0; k < axes_.size(); ++k) {
    if (results_[k] == ProofResult::kAbsent) throw absence(k);
    if (results_[k] == ProofResult::kUnderWay) continue;
    report.push_back(proof_line(k));
    if (!accepts(results_[k])) throw StartupError(report.back(), proof_remedy(k));
  }
  if (trouble_ != DriveTrouble::kNone)
    throw StartupError("CAN: " + std::string(name(trouble_)), "see that the bus is up and the drives are powered");
  return report;
}

std::string MotorPair::inspect(std::size_t side) {
  await_motor(side);
  begin_proof(side);
  ProofResult result = ProofResult::kUnderWay;
  while ((result = continue_proof(side)) == ProofResult::kUnderWay) pass_time();
  if (!accepts(result)) throw StartupError(proof_line(side), proof_remedy(side));
  return proof_line(side);
}

void MotorPair::await_motor(std::size_t index) {
  axes_[index].forget();
  wake(true);
  for (const Time began = clock_.now(); !axes_[index].shows_itself() && clock_.now() - began < setup_.answer_limit;) {
    wake(false);
    pass_time();
  }
  if (!axes_[index].shows_itself()) throw absence(index);
}

void MotorPair::prove() noexcept {
  if (!proving_) begin_proofs();
  continue_proofs();
}

void MotorPair::begin_proofs() noexcept {
  proving_ = true;
  proved_ = both_shown_ = false;
  under_proof_ = 0;
  results_ = {};
  proofs_began_ = clock_.now();
  for (MotorAxis& a : axes_) a.forget();
  wake(true);
}

/// One motor after the other, once both show themselves.
void MotorPair::continue_proofs() noexcept {
  if (both_shown_) return finish_proof(continue_proof(under_proof_));
  wake(false);
  const bool late = clock_.now() - proofs_began_ > setup_.answer_limit;
  for (under_proof_ = 0; under_proof_ < axes_.size(); ++under_proof_)
    if (!axes_[under_proof_].shows_itself()) return late ? finish_proof(ProofResult::kAbsent) : void();
  both_shown_ = true;
  under_proof_ = 0;
  begin_proof(0);
}

void MotorPair::finish_proof(ProofResult result) noexcept {
  results_[under_proof_] = result;
  if (result == ProofResult::kUnderWay) return;
  if (!accepts(result)) return latch(DriveTrouble::kNotProved);
  if (trouble_ != DriveTrouble::kNone) return;
  if (++under_proof_ < axes_.size()) return begin_proof(under_proof_);
  proving_ = false;
  proved_ = true;
}

void MotorPair::pass_time() {
  clock_.sleep_until(clock_.now() + std::chrono::milliseconds(1));
  receive();
}

}  // namespace jaywalk
