#include "drivers/canopen/drive_base.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "hal/types/errors.h"

namespace jaywalk::canopen {
namespace {

constexpr Duration kArmingStep = std::chrono::milliseconds(1);
constexpr Duration kListening = std::chrono::milliseconds(300);  ///< for another master, before anything is sent
constexpr Duration kSettling =
    std::chrono::milliseconds(200);  ///< what a drive may take to leave a fault after a reset

DriveProof proof_for(CanBus& bus, const DriveBaseSetup& setup, std::size_t side) {
  DriveSettings settings = setup.settings;
  const double counts = setup.stop.tolerance_radps * std::fabs(setup.axes[side].per_rad);
  settings.standstill = static_cast<std::uint32_t>(std::fmin(counts, 2147483647.0));
  return {bus, setup.axes[side].node, settings, setup.allow_unproved};
}

}  // namespace

CanopenDriveBase::CanopenDriveBase(CanBus& bus, Clock& clock, const DriveBaseSetup& setup)
    : bus_(bus),
      clock_(clock),
      setup_(setup),
      axes_{WheelAxis(setup.axes[0], std::chrono::milliseconds(setup.settings.heartbeat_ms)),
            WheelAxis(setup.axes[1], std::chrono::milliseconds(setup.settings.heartbeat_ms))},
      proofs_{proof_for(bus, setup, 0), proof_for(bus, setup, 1)},
      masters_(masters_identifiers(setup.settings.controller_node, {setup.axes[0].node, setup.axes[1].node})),
      ladder_(setup.stop) {
  require_axes(setup.axes, "node", 1, 127, setup.settings.controller_node);
}

std::vector<std::string> CanopenDriveBase::arm() {
  begin_proof();
  while (is_proving()) {
    clock_.sleep_until(now() + kArmingStep);
    static_cast<void>(latest());
  }
  if (trouble_ != DriveTrouble::kNone) refuse();
  std::vector<std::string> report = proofs_[0].report();
  for (std::string& line : proofs_[1].report()) report.push_back(std::move(line));
  return report;
}

void CanopenDriveBase::refuse() const {
  if (foreign_) {
    throw StartupError("CAN: " + std::string(name(trouble_)) + ": " + describe_foreign(*foreign_),
                       "end the other program or machine, or give it a bus of its own");
  }
  for (const DriveProof& proof : proofs_) {
    if (proof.state() != DriveProof::State::kFailed) continue;
    throw StartupError(proof.failure(), proof.remedy());
  }
  throw StartupError("CAN: " + std::string(name(trouble_)), "see that the bus is up and the drives are powered");
}

void CanopenDriveBase::conduct(ArmingProof& proof) {
  ReceivedFrame received;
  while (!proof.done()) {
    proof.poll(clock_.now());
    clock_.sleep_until(clock_.now() + kArmingStep);
    while (bus_.receive(received)) proof.on_frame(received.frame, clock_.now());
  }
}

std::string CanopenDriveBase::inspect(std::size_t side) {
  const std::uint8_t node = axes_[side].setup().node;
  const std::string who = "node " + std::to_string(node);
  ArmingProof identity(bus_, node, identity_items());
  conduct(identity);
  if (identity.lines()[0].verdict == ProofVerdict::kSilent) throw StartupError(who + ": no answer", kSilentDrive);
  if (!speaks_profile_velocity(identity.lines()))
    throw StartupError(who + ": is no CiA 402 drive with profile velocity, by its 1000h and 6502h", "use one that is");
  ArmingProof::Lines items = proof_items(node, setup_.settings);
  for (ProofLine& item : items) item.demand = ProofDemand::kHeld;
  ArmingProof settings(bus_, node, items);
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

void CanopenDriveBase::begin_proof() noexcept {
  trouble_ = DriveTrouble::kNone;
  fault_ = {};
  foreign_.reset();
  ladder_.reset();
  awaits_zero_ = true;
  phase_ = Phase::kListening;
  began_ = now();
}

// A step at a time; of what comes next, another master's frames may still say no.
void CanopenDriveBase::follow_proof() noexcept {
  if (phase_ == Phase::kListening) {
    if (now() - began_ < kListening) return;
    phase_ = Phase::kProving;
    for (DriveProof& proof : proofs_) proof.begin(now());
    return;
  }
  const auto count = [this](DriveProof::State state) {
    return std::count_if(proofs_.begin(), proofs_.end(), [state](const DriveProof& p) { return p.state() == state; });
  };
  for (DriveProof& proof : proofs_) proof.poll(now());
  const auto failed = count(DriveProof::State::kFailed);
  // All that is wrong with both drives is to be known: the one waits for the other.
  if (failed + count(DriveProof::State::kPassed) < 2) return;
  if (failed > 0) return latch(DriveTrouble::kNotProved);
  begin_operation();
}

void CanopenDriveBase::begin_operation() noexcept {
  phase_ = Phase::kProved;
  began_ = now();
  bus_watch_.begin(bus_.health());
  const bool heard_all = std::exchange(frames_lost_, bus_.health().frames_lost) == bus_.health().frames_lost;
  for (std::size_t k = 0; k < axes_.size(); ++k) {
    const bool counts_on = axes_[k].begin(proofs_[k].heard(), began_ + kSettling, heard_all);
    counts_on_ = counts_on_ && counts_on;
  }
}

WheelState CanopenDriveBase::latest() noexcept {
  ReceivedFrame received;
  for (int taken = 0; taken < kMostFramesATick && bus_.receive(received); ++taken) take(received);
  if (is_proving()) follow_proof();
  watch();
  wheels_.trouble = trouble_;
  wheels_.fault = fault_;
  wheels_.stop = ladder_.stage();
  wheels_.ready = is_proved() && !awaits_zero_ && follow_speeds();
  return wheels_;
}

void CanopenDriveBase::take(const ReceivedFrame& received) noexcept {
  if (phase_ != Phase::kUnproved && is_foreign(received)) note_foreign(received.frame);
  for (std::size_t k = 0; k < axes_.size(); ++k) {
    axes_[k].take(received);
    if (phase_ == Phase::kProved && axes_[k].has_twin()) note_foreign(received.frame);
    if (phase_ == Phase::kProving) proofs_[k].on_frame(received);
    // Before that it tells of what was: that it missed the heartbeat.
    const std::uint8_t node = axes_[k].setup().node;
    const std::uint16_t error = emergency_in(received.frame, node).value_or(0);
    if (phase_ != Phase::kProved || error == 0) continue;
    note({DriveFaultKind::kEmergency, node, error});
    latch(DriveTrouble::kEmergency);
  }
  publish(received.stamp);
}

void CanopenDriveBase::note_foreign(const CanFrame& frame) noexcept {
  if (!foreign_) foreign_ = frame;
  latch(DriveTrouble::kForeignMaster);
}

bool CanopenDriveBase::is_foreign(const ReceivedFrame& received) const noexcept {
  const CanFrame& frame = received.frame;
  if (frame.extended || frame.remote) return false;
  if (std::find(masters_.begin(), masters_.end(), frame.id) != masters_.end()) return true;
  // An answer to an SDO request of another's. Ours may come as long as a transfer takes.
  const bool asks = phase_ == Phase::kProving || trouble_ != DriveTrouble::kNone;
  if (asks || received.stamp - began_ <= kAnswerTimeout) return false;
  return std::any_of(axes_.begin(), axes_.end(),
                     [&](const WheelAxis& axis) { return frame.id == 0x580U + axis.setup().node; });
}

void CanopenDriveBase::publish(Time stamp) noexcept {
  if (!axes_[0].is_complete() || !axes_[1].is_complete()) return;
  wheels_ = {.stamp = stamp,
             .sequence = counts_on_ ? wheels_.sequence + 1 : 1,
             .left_rad = axes_[0].turned_rad(),
             .right_rad = axes_[1].turned_rad(),
             .left_radps = axes_[0].feedback().speed_radps,
             .right_radps = axes_[1].feedback().speed_radps};
  counts_on_ = true;
  for (WheelAxis& axis : axes_) axis.used();
}

void CanopenDriveBase::watch() noexcept {
  if (phase_ != Phase::kProved) return;
  if (!bus_watch_.is_well(bus_.health())) latch(DriveTrouble::kBusUnwell);
  for (WheelAxis& axis : axes_) {
    const DriveTrouble trouble = axis.trouble(now(), setup_.silence_limit, setup_.stop.fresh);
    if (trouble == DriveTrouble::kNotProved) note({DriveFaultKind::kMode, axis.setup().node, axis.mode()});
    if (trouble != DriveTrouble::kNone) latch(trouble);
  }
}

// The first trouble is the one worth knowing: the others follow from it. A proof that is under way is over.
void CanopenDriveBase::latch(DriveTrouble trouble) noexcept {
  if (trouble_ == DriveTrouble::kNone) trouble_ = trouble;
  if (is_proving()) phase_ = Phase::kUnproved;
}

void CanopenDriveBase::reset() noexcept {
  if (is_proving()) return;
  if (!is_proved()) return begin_proof();
  awaits_zero_ = true;
  ladder_.reset();
}

bool CanopenDriveBase::is_enabled() const noexcept {
  return phase_ == Phase::kProved && axes_[0].is_enabled() && axes_[1].is_enabled();
}

void CanopenDriveBase::command(const WheelCommand& command) noexcept {
  if (is_proving()) return follow_proof();
  const bool finite = std::isfinite(command.left_radps) && std::isfinite(command.right_radps);
  const bool is_zero = command.left_radps == 0.0 && command.right_radps == 0.0;
  if (is_zero && is_proved()) awaits_zero_ = false;
  const bool moves = !awaits_zero_ && follow_speeds() && finite;  // both wheels or none
  const std::array speeds_radps{moves ? command.left_radps : 0.0, moves ? command.right_radps : 0.0};
  cycle(awaits_zero_ ? DriveGoal::kOff : DriveGoal::kEnabled, is_zero || !finite, speeds_radps);
}

void CanopenDriveBase::disarm() noexcept {
  awaits_zero_ = true;
  if (is_proving()) phase_ = Phase::kUnproved;
  cycle(are_at_rest() ? DriveGoal::kOff : DriveGoal::kQuickStop, true, {});
}

bool CanopenDriveBase::are_at_rest() const noexcept {
  return std::all_of(axes_.begin(), axes_.end(), [this](const WheelAxis& axis) {
    return std::fabs(axis.feedback().speed_radps) <= setup_.stop.tolerance_radps;
  });
}

void CanopenDriveBase::cycle(DriveGoal goal, bool stopping, const std::array<double, 2>& speeds_radps) noexcept {
  if (phase_ != Phase::kProved && trouble_ == DriveTrouble::kNone)
    return;  // neither drive is armed, or a proof is under way
  const bool in_trouble = trouble_ != DriveTrouble::kNone;
  std::array<WheelFeedback, 2> felt{axes_[0].feedback(), axes_[1].feedback()};
  for (std::size_t k = 0; k < felt.size(); ++k) felt[k].told_radps = speeds_radps[k];
  const StopStage stage = ladder_.update(now(), stopping || in_trouble, in_trouble, felt);
  if (stage != StopStage::kNone) latch(DriveTrouble::kStopUnconfirmed);
  if (stage == StopStage::kSilent) return;
  // A drive that was not proved is not fed, nor is one that did not obey a quick stop.
  const bool feeds = phase_ == Phase::kProved && stage != StopStage::kNetworkStop;
  if (feeds) send(heartbeat_frame(setup_.settings.controller_node, NmtState::kOperational));
  if (stage == StopStage::kNone) return send_targets(goal, speeds_radps);
  send_targets(DriveGoal::kQuickStop, {});
  for (const WheelAxis& axis : axes_)
    if (stage == StopStage::kNetworkStop)
      send(nmt_frame(NmtCommand::kStop, axis.setup().node));
    else if (!axis.is_operational())
      send(axis.quick_stop_request());
}

void CanopenDriveBase::send_targets(DriveGoal goal, const std::array<double, 2>& speeds_radps) noexcept {
  for (std::size_t k = 0; k < axes_.size(); ++k) send(axes_[k].target(goal, speeds_radps[k]));
  send(sync_frame());
  for (WheelAxis& axis : axes_) axis.note_sync(now());
}

}  // namespace jaywalk::canopen
