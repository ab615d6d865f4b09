#include "drivers/canopen/drive_base.h"

#include <algorithm>
#include <cmath>

#include "drivers/canopen/services.h"
#include "hal/types/errors.h"

namespace jaywalk::canopen {

namespace {

/// Frames that one tick takes in: a bus at 1 Mbit/s brings some 9000 a second.
constexpr int kMostAtOnce = 512;
constexpr Duration kArmingStep = std::chrono::milliseconds(1);

std::int32_t to_counts(double speed_radps, double counts_per_rad) noexcept {
  constexpr double kMost = 2147483647.0;
  const double counts = std::clamp(speed_radps * counts_per_rad, -kMost, kMost);
  return static_cast<std::int32_t>(counts < 0.0 ? counts - 0.5 : counts + 0.5);
}

}  // namespace

CanopenDriveBase::CanopenDriveBase(CanBus& bus, Clock& clock, const DriveBaseSetup& setup)
    : bus_(bus), clock_(clock), setup_(setup) {
  for (std::size_t k = 0; k < axes_.size(); ++k) {
    const AxisSetup& axis = setup.axes[k];
    const bool node_fits = axis.node >= 1 && axis.node <= 127 && axis.node != setup.settings.controller_node;
    if (!node_fits || !std::isfinite(axis.counts_per_rad) || axis.counts_per_rad == 0.0) {
      throw StartupError(std::string(k == 0 ? "left" : "right") + " drive: cannot be set up so",
                         "give it a node from 1 to 127 other than the controller's, and its counts per radian");
    }
    axes_[k].setup = axis;
    axes_[k].command_mapping = command_pdo(axis.node).mapping;
    axes_[k].status_mapping = status_pdo(axis.node).mapping;
    axes_[k].position_mapping = position_pdo(axis.node).mapping;
  }
  if (axes_[0].setup.node == axes_[1].setup.node) {
    throw StartupError("drives: both have node " + std::to_string(axes_[0].setup.node), "give each a node of its own");
  }
}

std::vector<std::string> CanopenDriveBase::arm() {
  std::vector<std::string> report;
  for (Axis& axis : axes_) {
    send(nmt_frame(NmtCommand::kPreOperational, axis.setup.node));
    prove(axis, report);
  }
  for (Axis& axis : axes_) {
    send(nmt_frame(NmtCommand::kStart, axis.setup.node));
    axis.heard = clock_.now();
  }
  if (trouble_ != DriveTrouble::kNone) {
    throw StartupError("CAN: " + std::string(name(trouble_)), "see that the bus is up and the drives are powered");
  }
  settled_ = clock_.now() + setup_.settling;  // heartbeats from before the start still say "pre-operational"
  armed_ = true;
  return report;
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
  const std::uint8_t node = axes_[side].setup.node;
  const std::string who = "node " + std::to_string(node);
  ArmingProof identity(bus_, node, identity_items(), setup_.answer_timeout);
  conduct(identity);
  if (identity.lines()[0].verdict == ProofVerdict::kSilent) {
    throw StartupError(who + ": no answer", "see that it has power, this number and the bus's bit rate");
  }
  if (!speaks_profile_velocity(identity.lines())) {
    throw StartupError(who + ": is no CiA 402 drive with profile velocity, by its 1000h and 6502h", "use one that is");
  }
  ArmingProof::Items items = proof_items(node, setup_.settings);
  for (ProofItem& item : items) item.write = false;
  ArmingProof settings(bus_, node, items, setup_.answer_timeout);
  conduct(settings);
  const std::size_t behaviours = behaviour_items(setup_.settings).size();  // the first of all
  std::string lacking;
  std::size_t as_wanted = 0;
  for (std::size_t k = 0; k < settings.lines().size(); ++k) {
    const ProofLine& line = settings.lines()[k];
    if (line.verdict == ProofVerdict::kProved && k < behaviours) ++as_wanted;
    if (line.verdict == ProofVerdict::kProved || line.verdict == ProofVerdict::kDiffers) continue;
    lacking += (lacking.empty() ? "" : "; ") + describe(line);
  }
  if (!lacking.empty() && !setup_.allow_unproved) {
    throw StartupError(who + ": " + lacking, "use a drive that has it, or allow_unproved at your own risk");
  }
  return who + ": CiA 402, profile velocity; " + std::to_string(as_wanted) + " of " + std::to_string(behaviours) +
         " settings stand as arming writes them" + (lacking.empty() ? "" : "; " + lacking);
}

void CanopenDriveBase::prove(Axis& axis, std::vector<std::string>& report) {
  ArmingProof proof(bus_, axis.setup.node, proof_items(axis.setup.node, setup_.settings), setup_.answer_timeout);
  conduct(proof);
  const std::string who = "node " + std::to_string(axis.setup.node) + ": ";
  for (const ProofLine& line : proof.lines()) report.push_back(who + describe(line));
  if (proof.proved() || setup_.allow_unproved) return;
  const auto* const open = std::find_if(proof.lines().begin(), proof.lines().end(),
                                        [](const ProofLine& l) { return l.verdict != ProofVerdict::kProved; });
  throw StartupError(who + describe(*open), "use a drive that can prove it, or allow_unproved at your own risk");
}

WheelState CanopenDriveBase::latest() noexcept {
  ReceivedFrame received;
  for (int taken = 0; taken < kMostAtOnce && bus_.receive(received); ++taken) take(received);
  watch();
  wheels_.trouble = trouble_;
  return wheels_;
}

void CanopenDriveBase::take(const ReceivedFrame& received) noexcept {
  const auto heartbeat = decode_heartbeat(received.frame);
  const auto emergency = decode_emergency(received.frame);
  for (Axis& axis : axes_) {
    const std::uint8_t node = axis.setup.node;
    if (heartbeat && heartbeat->node == node) {
      axis.heard = received.stamp;
      if (heartbeat->state != NmtState::kOperational && received.stamp > settled_) latch(DriveTrouble::kDriveRestarted);
    }
    if (emergency && emergency->node == node && emergency->error_code != 0) latch(DriveTrouble::kEmergency);
    if (received.frame.extended) continue;
    if (received.frame.id == 0x180U + node) take_status(axis, received.frame);
    if (received.frame.id == 0x280U + node) take_position(axis, received.frame);
  }
  publish(received.stamp);
}

void CanopenDriveBase::take_status(Axis& axis, const CanFrame& frame) noexcept {
  const auto values = unpack(axis.status_mapping, frame);
  if (!values) return;
  axis.state = state_of(static_cast<std::uint16_t>((*values)[0]));
  axis.speed_radps = static_cast<double>(static_cast<std::int32_t>((*values)[1])) / axis.setup.counts_per_rad;
  axis.fresh_status = true;
}

// The position wraps at 32 bits: the difference, as a signed number, is right across the wrap.
void CanopenDriveBase::take_position(Axis& axis, const CanFrame& frame) noexcept {
  const auto values = unpack(axis.position_mapping, frame);
  if (!values) return;
  const std::uint32_t raw = (*values)[0];
  if (axis.has_position) axis.counts += static_cast<std::int32_t>(raw - axis.raw_position);
  axis.raw_position = raw;
  axis.has_position = true;
  axis.fresh_position = true;
}

void CanopenDriveBase::publish(Time stamp) noexcept {
  const auto complete = [](const Axis& axis) { return axis.fresh_status && axis.fresh_position; };
  if (!std::all_of(axes_.begin(), axes_.end(), complete)) return;
  const auto turned = [](const Axis& axis) { return static_cast<double>(axis.counts) / axis.setup.counts_per_rad; };
  wheels_ = {.stamp = stamp,
             .sequence = wheels_.sequence + 1,
             .left_rad = turned(axes_[0]),
             .right_rad = turned(axes_[1]),
             .left_radps = axes_[0].speed_radps,
             .right_radps = axes_[1].speed_radps};
  for (Axis& axis : axes_) axis.fresh_status = axis.fresh_position = false;
}

void CanopenDriveBase::watch() noexcept {
  if (!armed_) return;
  const Time now = clock_.now();
  if (!bus_watch_.is_well(bus_.health())) latch(DriveTrouble::kBusUnwell);
  for (Axis& axis : axes_) {
    if (age(axis.heard, now) > setup_.silence_limit) latch(DriveTrouble::kDriveSilent);
    const bool in_fault = axis.state == DriveState::kFault || axis.state == DriveState::kFaultReactionActive;
    if (in_fault && now > settled_) latch(DriveTrouble::kDriveFault);
    if (axis.state == DriveState::kOperationEnabled) {
      axis.was_enabled = true;
    } else if (axis.was_enabled) {
      latch(DriveTrouble::kLeftOperation);
    }
  }
}

// The first trouble is the one worth knowing: the others follow from it.
void CanopenDriveBase::latch(DriveTrouble trouble) noexcept {
  if (trouble_ == DriveTrouble::kNone) trouble_ = trouble;
}

void CanopenDriveBase::reset() noexcept {
  trouble_ = DriveTrouble::kNone;
  awaits_zero_ = true;
  reset_pulse_ = true;
  settled_ = clock_.now() + setup_.settling;
  for (Axis& axis : axes_) axis.was_enabled = false;
}

bool CanopenDriveBase::is_enabled() const noexcept {
  return std::all_of(axes_.begin(), axes_.end(),
                     [](const Axis& axis) { return axis.state == DriveState::kOperationEnabled; });
}

void CanopenDriveBase::command(const WheelCommand& command) noexcept {
  const bool finite = std::isfinite(command.left_radps) && std::isfinite(command.right_radps);
  if (command.left_radps == 0.0 && command.right_radps == 0.0) awaits_zero_ = false;
  DriveGoal goal = awaits_zero_ ? DriveGoal::kOff : DriveGoal::kEnabled;
  if (trouble_ != DriveTrouble::kNone) goal = DriveGoal::kQuickStop;
  const bool moves = goal == DriveGoal::kEnabled && is_enabled() && finite;  // both wheels or none
  send_cycle(goal, moves ? command.left_radps : 0.0, moves ? command.right_radps : 0.0);
}

void CanopenDriveBase::disarm() noexcept {
  awaits_zero_ = true;
  for (Axis& axis : axes_) axis.was_enabled = false;  // it leaves operation because it was asked to
  send_cycle(DriveGoal::kOff, 0.0, 0.0);
}

void CanopenDriveBase::send_cycle(DriveGoal goal, double left_radps, double right_radps) noexcept {
  send(heartbeat_frame(setup_.settings.controller_node, NmtState::kOperational));
  send_target(axes_[0], goal, left_radps);
  send_target(axes_[1], goal, right_radps);
  send(sync_frame());
  reset_pulse_ = false;
}

void CanopenDriveBase::send_target(Axis& axis, DriveGoal goal, double wanted_radps) noexcept {
  const std::uint16_t controlword = controlword_towards(goal, axis.state, reset_pulse_);
  const std::int32_t target = to_counts(wanted_radps, axis.setup.counts_per_rad);
  const std::array<std::uint32_t, 2> values{controlword, static_cast<std::uint32_t>(target)};
  if (const auto frame = pack(axis.command_mapping, 0x200U + axis.setup.node, values)) send(*frame);
}

void CanopenDriveBase::send(const CanFrame& frame) noexcept {
  if (bus_.send(frame) != SendResult::kQueued) latch(DriveTrouble::kBusRefused);
}

}  // namespace jaywalk::canopen
