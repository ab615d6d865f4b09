#include "drivers/canopen/drive_base.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "hal/types/errors.h"

namespace jaywalk::canopen {
namespace {

constexpr Duration kArmingStep = std::chrono::milliseconds(1);

WheelAxis axis_of(const DriveBaseSetup& setup, std::size_t side) {
  return {setup.axes[side], std::chrono::milliseconds(setup.settings.heartbeat_ms), setup.showing};
}

DriveProof proof_for(CanBus& bus, const DriveBaseSetup& setup, std::size_t side) {
  DriveProofSetup proof{setup.settings, setup.answer_timeout, setup.starting, setup.allow_unproved};
  const double counts = setup.stop.tolerance_radps * std::fabs(setup.axes[side].per_rad);
  proof.settings.standstill = static_cast<std::uint32_t>(std::fmin(counts, 2147483647.0));
  return {bus, setup.axes[side].node, proof};
}

}  // namespace

CanopenDriveBase::CanopenDriveBase(CanBus& bus, Clock& clock, const DriveBaseSetup& setup)
    : MotorPair(bus, clock,
                {.silence_limit = setup.silence_limit,
                 .settling = setup.settling,
                 .stop = setup.stop,
                 .allow_unproved = setup.allow_unproved}),
      bus_(bus),
      setup_(setup),
      axes_{axis_of(setup, 0), axis_of(setup, 1)},
      proofs_{proof_for(bus, setup, 0), proof_for(bus, setup, 1)},
      masters_(masters_identifiers(setup.settings.controller_node, {setup.axes[0].node, setup.axes[1].node})) {
  require_axes(setup.axes, {"node", 1, 127, setup.settings.controller_node});
}

StartupError CanopenDriveBase::refusal(const CanFrame& foreign) const {
  return {"CAN: another master on the bus: " + describe_foreign(foreign),
          "end the other program or machine, or give it a bus of its own"};
}

StartupError CanopenDriveBase::absence(std::size_t index) const {
  return {"node " + std::to_string(axes_[index].node()) + ": no answer", kSilentDrive};
}

std::vector<std::string> CanopenDriveBase::proof_report(std::size_t index) const { return proofs_[index].report(); }

void CanopenDriveBase::conduct(ArmingProof& proof) {
  ReceivedFrame received;
  while (!proof.done()) {
    proof.poll(clock().now());
    clock().sleep_until(clock().now() + kArmingStep);
    while (bus_.receive(received)) proof.on_frame(received.frame, clock().now());
  }
}

std::string CanopenDriveBase::inspect(std::size_t side) {
  const std::uint8_t node = axes_[side].node();
  const std::string who = "node " + std::to_string(node);
  ArmingProof identity(bus_, node, identity_items(), setup_.answer_timeout);
  conduct(identity);
  if (identity.lines()[0].verdict == ProofVerdict::kSilent) throw StartupError(who + ": no answer", kSilentDrive);
  if (!speaks_profile_velocity(identity.lines()))
    throw StartupError(who + ": is no CiA 402 drive with profile velocity, by its 1000h and 6502h", "use one that is");
  ArmingProof::Items items = proof_items(node, setup_.settings);
  for (ProofItem& item : items) item.demand = ProofDemand::kHeld;
  ArmingProof settings(bus_, node, items, setup_.answer_timeout);
  conduct(settings);
  const std::size_t behaviours = behaviour_items(setup_.settings).size();  // the first of all
  std::string lacking;
  const ProofLine* refusing = nullptr;
  std::size_t as_wanted = 0;
  for (std::size_t k = 0; k < settings.lines().size(); ++k) {
    const ProofLine& line = settings.lines()[k];
    if (line.verdict == ProofVerdict::kProved && k < behaviours) ++as_wanted;
    if (line.verdict == ProofVerdict::kProved || line.verdict == ProofVerdict::kDiffers) continue;
    lacking += (lacking.empty() ? "" : "; ") + describe(line);
    const bool is_first = refusing == nullptr || (may_be_allowed(*refusing) && !may_be_allowed(line));
    if (is_first && !(setup_.allow_unproved && may_be_allowed(line))) refusing = &line;
  }
  if (refusing != nullptr) throw StartupError(who + ": " + lacking, remedy_for(*refusing));
  return who + ": CiA 402, profile velocity; " + std::to_string(as_wanted) + " of " + std::to_string(behaviours) +
         " settings stand as arming writes them" + (lacking.empty() ? "" : "; " + lacking);
}

// Both at once: all that is wrong with both drives is to be known. arm() has listened already.
void CanopenDriveBase::begin_proof(std::size_t index) noexcept {
  if (index > 0) return;
  fed_ = asks_ = false;
  listens_since_ = is_armed() ? clock().now() : kNever;
  asked_ = clock().now();
}

ProofResult CanopenDriveBase::continue_proof(std::size_t index) noexcept {
  const Time now = clock().now();
  if (listens_since_ != kNever && now - listens_since_ < kListening) return ProofResult::kUnderWay;
  if (!std::exchange(asks_, true))
    for (DriveProof& proof : proofs_) proof.begin(now);
  asked_ = now;
  for (DriveProof& proof : proofs_) proof.poll(now), proof.poll(now);  // takes an answer, and asks what is next
  for (const DriveProof& proof : proofs_)
    if (proof.state() != DriveProof::State::kPassed && proof.state() != DriveProof::State::kFailed)
      return ProofResult::kUnderWay;
  if (proofs_[index].state() == DriveProof::State::kFailed) return ProofResult::kFailed;
  if (index == 1) {
    fed_ = true;
    for (std::size_t k = 0; k < axes_.size(); ++k) axes_[k].begin(), note_heard(k, now);
  }
  return ProofResult::kPassed;
}

void CanopenDriveBase::watch_motor(std::size_t index) noexcept {
  if (!fed_) return;
  if (axes_[index].is_unanswered(clock().now(), setup_.stop.fresh)) lose_proof(DriveTrouble::kDriveSilent);
  if (axes_[index].in_fault()) report_fault(DriveTrouble::kDriveFault, {});
}

void CanopenDriveBase::take(const ReceivedFrame& received) noexcept {
  if (is_foreign(received)) note_foreign(received.frame);
  const auto emergency = decode_emergency(received.frame);
  for (std::size_t k = 0; k < axes_.size(); ++k) {
    if (asks_ && !fed_) proofs_[k].on_frame(received);
    take_axis(k, received);
    // Before that it tells of what was: that it missed the heartbeat.
    if (!fed_ || !emergency || emergency->error_code == 0 || emergency->node != axes_[k].node()) continue;
    note({DriveFaultKind::kEmergency, emergency->node, emergency->error_code});
    latch(DriveTrouble::kEmergency);
  }
}

void CanopenDriveBase::take_axis(std::size_t index, const ReceivedFrame& received) noexcept {
  WheelAxis& axis = axes_[index];
  const AxisNews news = axis.take(received);
  if (news.heartbeat && fed_) note_heard(index, received.stamp);  // before, it may not be set up to say any
  if (news.turned_rad) note_turned(index, received.stamp, *news.turned_rad);
  if (news.status) {
    note_speed(index, received.stamp, axis.speed_radps());
    note_obeys(index, axis.follows_speeds());
  }
  if (!fed_) return;
  if (axis.has_twin()) note_foreign(received.frame);
  if (news.trouble == DriveTrouble::kNotProved) note({DriveFaultKind::kMode, axis.node(), axis.mode()});
  if (news.trouble != DriveTrouble::kNone) latch(news.trouble);
}

bool CanopenDriveBase::is_foreign(const ReceivedFrame& received) const noexcept {
  const CanFrame& frame = received.frame;
  if (frame.extended || frame.remote) return false;
  if (std::find(masters_.begin(), masters_.end(), frame.id) != masters_.end()) return true;
  // An answer to an SDO request of another's. Ours may come as long as a transfer takes.
  if (trouble() != DriveTrouble::kNone || age(asked_, received.stamp) <= setup_.answer_timeout) return false;
  return std::any_of(axes_.begin(), axes_.end(),
                     [&](const WheelAxis& axis) { return frame.id == 0x580U + axis.node(); });
}

// A drive that was not proved is not fed, nor are both where one did not obey a quick stop.
void CanopenDriveBase::begin_cycle() noexcept {
  commands_ = false;
  if (fed_ && stop_stage() < StopStage::kNetworkStop)
    send(heartbeat_frame(setup_.settings.controller_node, NmtState::kOperational));
}

void CanopenDriveBase::send_order(std::size_t index, MotorOrder order, double speed_radps) noexcept {
  const bool in_trouble = trouble() != DriveTrouble::kNone;
  if (!fed_ && !in_trouble) return;  // no drive was armed
  commands_ = true;
  WheelAxis& axis = axes_[index];
  send(axis.target(in_trouble                  ? DriveGoal::kQuickStop
                   : order == MotorOrder::kOff ? DriveGoal::kOff
                                               : DriveGoal::kEnabled,
                   speed_radps));
  if (order == MotorOrder::kNetworkStop)
    send(nmt_frame(NmtCommand::kStop, axis.node()));
  else if (in_trouble && !axis.is_operational())
    send(axis.quick_stop_request());
}

void CanopenDriveBase::end_cycle() noexcept {
  if (!commands_) return;
  send(sync_frame());
  for (WheelAxis& axis : axes_) axis.note_sync(clock().now());
}

}  // namespace jaywalk::canopen
