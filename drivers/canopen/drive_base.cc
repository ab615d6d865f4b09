#include "drivers/canopen/drive_base.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "drivers/canopen/drive_proof.h"
#include "hal/types/errors.h"

namespace jaywalk::canopen {
namespace {

std::int32_t to_counts(double speed_radps, double per_rad) noexcept {
  constexpr double kMost = 2147483647.0;
  const double counts = std::clamp(speed_radps * per_rad, -kMost, kMost);
  return static_cast<std::int32_t>(counts < 0.0 ? counts - 0.5 : counts + 0.5);
}

constexpr std::uint32_t kNmt = 0x000, kSync = 0x080, kLss = 0x7E5, kHeartbeat = 0x700, kSdoRequest = 0x600,
                        kSdoAnswer = 0x580;
constexpr std::array<std::uint32_t, 4> kReceivePdos{0x200, 0x300, 0x400, 0x500};

std::string kind_of(std::uint32_t id) {
  if (id == kNmt) return "NMT command";
  if (id == kSync) return "SYNC";
  if (id == kLss) return "LSS command";
  const std::string node = " node " + std::to_string(id & 0x7FU);
  const std::uint32_t base = id & ~0x7FU;
  if (base == kHeartbeat) return "heartbeat of" + node;
  if (base == kSdoRequest) return "SDO request to" + node;
  if (base == kSdoAnswer) return "SDO answer that was not asked for, of" + node;
  const bool from_drive = base == 0x180 || base == 0x280;  // of which two are too many
  return (from_drive ? "process data, too often, of" : "process data to") + node;
}

}  // namespace

WheelAxis::WheelAxis(const CanAxis& setup, Duration heartbeat, Duration showing) noexcept
    : setup_(setup),
      heartbeat_(heartbeat),
      showing_(showing),
      command_mapping_(command_pdo(setup.node).mapping),
      status_mapping_(status_pdo(setup.node).mapping),
      position_mapping_(position_pdo(setup.node).mapping) {}

AxisNews WheelAxis::take(const ReceivedFrame& received) noexcept {
  const CanFrame& frame = received.frame;
  if (frame.extended) return {};
  const auto heartbeat = decode_heartbeat(frame);
  if (heartbeat && heartbeat->node == setup_.node) return take_heartbeat(heartbeat->state, received.stamp);
  if (frame.id == 0x180U + setup_.node) return take_status(received);
  if (frame.id == 0x280U + setup_.node) return take_position(frame);
  return {};
}

AxisNews WheelAxis::take_heartbeat(NmtState state, Time stamp) noexcept {
  has_twin_ = !heartbeats_.take_at(stamp, heartbeat_) || has_twin_;
  network_ = state;
  AxisNews news{.heartbeat = true};
  if (state == NmtState::kBootUp)
    news.trouble = DriveTrouble::kDriveRestarted;
  else if (state != NmtState::kOperational)
    news.trouble = DriveTrouble::kNotOperational;
  return news;
}

AxisNews WheelAxis::take_status(const ReceivedFrame& received) noexcept {
  has_twin_ = !statuses_.take() || has_twin_;
  const auto values = unpack(status_mapping_, received.frame);
  if (!values) return {};
  state_ = state_of(static_cast<std::uint16_t>((*values)[0]));
  speed_radps_ = static_cast<double>(static_cast<std::int32_t>((*values)[1])) / setup_.per_rad;
  mode_ = static_cast<std::uint8_t>((*values)[2]);
  unanswered_since_ = kNever;
  return {.status = true, .trouble = mode_trouble(received.stamp)};
}

// The position wraps at 32 bits: the difference, as a signed number, is right across the wrap.
AxisNews WheelAxis::take_position(const CanFrame& frame) noexcept {
  has_twin_ = !positions_.take() || has_twin_;
  const auto values = unpack(position_mapping_, frame);
  if (!values) return {};
  const std::uint32_t raw = (*values)[0];
  const auto counted = static_cast<std::int32_t>(raw - std::exchange(raw_position_, raw));
  return {.turned_rad = counted / setup_.per_rad};
}

DriveTrouble WheelAxis::mode_trouble(Time stamp) noexcept {
  if (!is_enabled()) {
    enabled_ = kNever;
    showed_mode_ = false;
    return DriveTrouble::kNone;
  }
  if (enabled_ == kNever) enabled_ = stamp;
  if (!follows_speeds() && showed_mode_) return DriveTrouble::kDriveRestarted;
  showed_mode_ = follows_speeds();
  return !showed_mode_ && stamp - enabled_ > showing_ ? DriveTrouble::kNotProved : DriveTrouble::kNone;
}

void WheelAxis::begin() noexcept {
  state_ = DriveState::kUnknown;
  unanswered_since_ = enabled_ = kNever;
  showed_mode_ = false;
  heartbeats_ = statuses_ = positions_ = {};
  has_twin_ = false;
}

void WheelAxis::note_sync(Time now) noexcept {
  if (unanswered_since_ == kNever) unanswered_since_ = now;
  statuses_.expect(1.0), positions_.expect(1.0);
}

CanFrame WheelAxis::target(DriveGoal goal, double wanted_radps) noexcept {
  const std::uint16_t controlword = controlword_towards(goal, state_, resets_fault_);
  if (state_ != DriveState::kUnknown) resets_fault_ = false;
  const std::int32_t target = to_counts(wanted_radps, setup_.per_rad);
  const std::array<std::uint32_t, 2> values{controlword, static_cast<std::uint32_t>(target)};
  return pack(command_mapping_, 0x200U + setup_.node, values).value_or(CanFrame{});
}

CanFrame WheelAxis::quick_stop_request() const noexcept {
  CanFrame frame;
  frame.id = 0x600U + setup_.node;
  frame.size = 8;
  // An expedited write of two bytes to 6040h.
  frame.bytes = {0x2B, 0x40, 0x60, 0x00};
  frame.bytes[4] =
      static_cast<std::uint8_t>(controlword_towards(DriveGoal::kQuickStop, DriveState::kOperationEnabled, false));
  return frame;
}

Identifiers masters_identifiers(std::uint8_t controller_node, const std::array<std::uint8_t, 2>& drives) noexcept {
  Identifiers ids;
  bool fit =
      ids.push_back(kNmt) && ids.push_back(kSync) && ids.push_back(kLss) && ids.push_back(kHeartbeat + controller_node);
  for (const std::uint8_t node : drives) {
    for (const std::uint32_t base : kReceivePdos) fit = fit && ids.push_back(base + node);
    fit = fit && ids.push_back(kSdoRequest + node);
  }
  assert(fit);
  static_cast<void>(fit);
  return ids;
}

std::string describe_foreign(const CanFrame& frame) { return kind_of(frame.id) + " (" + to_text(frame) + ")"; }

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
  for (DriveProof& proof : proofs_) {
    proof.poll(now);                  // takes an answer, or asks what is next
    if (is_armed()) proof.poll(now);  // a tick is longer than arming's steps: both
  }
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
