#include "firmware/robot/operator_desk.h"

#include <cmath>

#include "hal/types/errors.h"
#include "hal/types/wheels.h"

namespace jaywalk {

OperatorControls::OperatorControls(const RobotFile& file, WiredDrive& drive, Clock& clock,
                                   OperatorDesk::RestartBus restart_bus)
    : desk_(clock,
            {file.setup.goal_tolerance_m, file.goal_heading_tolerance_rad, file.places, file.setup.zones,
             file.setup.model.footprint.inscribed_radius_m()},
            std::move(restart_bus)),
      wiring_(file.panel) {
  if (wiring_) {
    watch_.emplace(clock, *wiring_);
    joystick_.emplace(desk_, *watch_, wiring_->needs_dead_man, file.setup.steering != StickUse::kNone);
  }
  gate_.emplace(joystick_ ? static_cast<OperatorPanel&>(*joystick_) : desk_, desk_.permission(), drive);
}

void OperatorControls::start(int priority) {
  if (!watch_) return;
  watch_->step();
  refuse_unrenewed(watch_->latest(), *wiring_);
  watch_->start(priority);
}

void refuse_unrenewed(const panel::JoystickState& state, const panel::JoystickSetup& wiring) {
  if (!state.needs_renewal || !wiring.needs_dead_man) return;
  throw StartupError(wiring.path + ": is on Bluetooth, whose link may die with the dead man held",
                     "give [panel] dead_man_renew_s, 2 say, or use a cable");
}

OperatorInput ResetGate::latest() noexcept {
  OperatorInput input = panel_.latest();
  input.stick = permission_.admitted(input.stick);
  const bool edge = !std::exchange(reset_before_, input.reset) && input.reset;
  if (input.emergency_stop) {
    permission_.revoke();
  } else if (edge && !turns_) {
    drive_.reset();
    permission_.let_reset_wait();
  }
  input.reset = permission_.reset_waits() && drive_.is_proved();
  if (input.reset) permission_.reset_is_done();
  return input;
}

namespace {

/// Faults of the drives, which a reset proves anew, and of the bus.
constexpr Reason kEndedByReset = Reason::kBus | Reason::kDrive | Reason::kStopUnconfirmed | Reason::kForeignMaster |
                                 Reason::kWheelsStale | Reason::kPoseDoubtful;

constexpr const char* kStillMoves = "refused: the robot still moves; try again when it stands\n";

/// Without the blanks, and the ends of lines, round it.
std::string_view trimmed(std::string_view line) noexcept {
  constexpr std::string_view kBlanks = " \t\r\n\v\f";
  const std::size_t begin = line.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) return {};
  return line.substr(begin, line.find_last_not_of(kBlanks) - begin + 1);
}

}  // namespace

ControlReply OperatorDesk::reply_to(std::string_view line) try {
  line = trimmed(line);
  if (const StopWords stop = stop_in(line); stop != StopWords::kNone) return take_stop(stop == StopWords::kStopNow);
  if (line == "status") return describe(status());
  if (line.starts_with("goto ")) return take_goal(line.substr(5));
  if (line.starts_with("here ")) return take_place(line.substr(5));
  if (line == "reset") return take_reset();
  return "refused: not understood; say goto X Y [HEADING], here X Y HEADING, stop, reset or status\n";
} catch (const StartupError& error) {
  return std::string("refused: ") + error.what() + "\n";
}

std::string OperatorDesk::obey(std::string_view line) {
  const ControlReply reply = reply_to(line);
  return reply.job ? reply.job() : reply.text;
}

RunStatus OperatorDesk::status() {
  const std::lock_guard lock(asking_);
  return statuses_.latest();
}

std::string OperatorDesk::take_stop(bool now) {
  const std::lock_guard lock(asking_);
  ++wish_.stops;
  if (now) ++wish_.emergencies;
  wish({});
  return "stopping\n";
}

void OperatorDesk::wish(const Orders& orders) {
  const std::uint32_t number = wish_.orders.number + 1;
  wish_.orders = orders;
  wish_.orders.number = number;
  wishes_.publish(wish_);
}

std::string OperatorDesk::take_goal(std::string_view words) {
  const Route route = read_route(words, rules_.places);
  for (const GoalOrder& order : route)
    if (is_kept_out(rules_.zones, order.position_in_map, rules_.body_m + kZoneMargin_m))
      return "refused: goto: " + words_of(order) + " lies in a keep-out zone or too near one; choose another place\n";
  const std::lock_guard lock(asking_);
  const RunStatus& status = statuses_.latest();
  const bool is_void = said_.is_void(words, status.revoked, clock_.now());
  if (const std::string why_not = goals_are_refused(status); !why_not.empty()) return why_not;
  if (is_void) {
    return "refused: it was stopped on its way there, and the goal is being repeated; give it again after " +
           std::to_string(SaidGoals::kSame_s) + " s without\n";
  }
  wish({.under = status.revoked, .route = route});
  return "going\n";
}

std::string OperatorDesk::goals_are_refused(const RunStatus& status) const {
  if (closed_) return "refused: the run is ending\n";
  if (!status.running) return "refused: the robot is not ready yet; try again\n";
  if (status.latched && !status.proved && status.drive == DriveTrouble::kNone)
    return "refused: the drives are being proved again; try again in some seconds\n";
  if (status.latched)
    return "refused: stopped by " + to_string(status.latched_by) + "; see to it, then jaywalk reset\n";
  if (is_stopping(status)) return "refused: the robot is still stopping; give the goal when it stands\n";
  return "";
}

ControlReply OperatorDesk::take_place(std::string_view words) {
  constexpr std::string_view kForce = " --force";
  const bool forced = words.ends_with(kForce);
  if (forced) words.remove_suffix(kForce.size());
  const Route route = read_route(words, rules_.places);
  const GoalOrder& place = route[0];
  if (route.size() != 1 || std::isnan(place.heading_rad)) return "refused: here: say one place, and its heading\n";
  const std::lock_guard lock(asking_);
  const RunStatus& status = statuses_.latest();
  if (!status.running) return "refused: the robot is not ready yet; try again\n";
  if (is_stopping(status) || !(status.speed_mps <= kAtRest_mps)) return kStillMoves;
  wish({.under = status.revoked,
        .here = Pose2{place.position_in_map.x, place.position_in_map.y, place.heading_rad},
        .forced = forced});
  return ControlReply(
      [this, order = wish_.orders.number, under = status.revoked] { return answer_to_place(order, under); });
}

RunStatus OperatorDesk::await(Duration longest, const std::function<bool(const RunStatus&)>& holds) {
  constexpr Duration kLook = std::chrono::milliseconds(20);
  const Time limit = clock_.now() + longest;
  RunStatus now = status();
  for (; !holds(now) && clock_.now() < limit; now = status()) clock_.sleep_until(clock_.now() + kLook);
  return now;
}

std::string OperatorDesk::answer_to_place(std::uint32_t order, std::uint32_t under) {
  const RunStatus now = await(std::chrono::seconds(15), [=](const RunStatus& status) {
    return status.place.number == order || status.revoked != under;
  });
  if (now.place.number == order) return words_of(now.place);
  if (now.revoked != under) return "refused: stopped anew meanwhile; say it again\n";
  return "refused: the run gives no answer; see jaywalk status\n";
}

ControlReply OperatorDesk::take_reset() {
  const std::lock_guard lock(asking_);
  const RunStatus& status = statuses_.latest();
  const bool is_off = status.bus.state == CanState::kBusOff;
  if (is_stopping(status) && !is_off) return kStillMoves;
  if (!status.latched) return "nothing to reset\n";
  // First of all: off the bus nobody knows how fast the wheels are.
  if (is_off) return ControlReply([this, before = wish_.stops] { return restart_bus_and_reset(before); });
  if (status.drive_is_silent)
    return "refused: still drive: one says nothing; see to its cable and power, then jaywalk reset\n";
  return reset_at_rest(status);
}

std::string OperatorDesk::restart_bus_and_reset(std::uint32_t stops) {
  if (const std::string complaint = restart_bus_(); !complaint.empty()) return "refused: " + complaint + "\n";
  const auto is_back = [](const RunStatus& status) { return status.bus.state != CanState::kBusOff; };
  if (!is_back(await(std::chrono::seconds(1), is_back)))
    return "refused: bus-off, and nobody is heard on the bus after a restart; see to the wires\n";
  const std::lock_guard lock(asking_);
  if (wish_.stops != stops) return "refused: stopped anew meanwhile; see to it, then jaywalk reset\n";
  return reset_at_rest(statuses_.latest());
}

std::string OperatorDesk::reset_at_rest(const RunStatus& status) {
  if (status.speed_mps > kAtRest_mps) return kStillMoves;
  if (has(status.reasons, Reason::kPoseDoubtful) && status.proved) {
    return "refused: nobody knows where the robot is: it was carried, or guessed over a gap; say jaywalk here X,Y "
           "HEADING, then jaywalk reset\n";
  }
  const Reason still = without(status.reasons, kNoFaults | kEndedByReset);
  if (still != Reason::kNone) return "refused: still " + to_string(still) + "; see to it, then jaywalk reset\n";
  wish({.under = status.revoked, .reset = true});
  return "reset\n";
}

void OperatorDesk::close() {
  const std::lock_guard lock(asking_);
  closed_ = true;
  ++wish_.stops;
  wish({});
}

OperatorInput OperatorDesk::latest() noexcept {
  const Wish& wish = wishes_.latest();
  const bool is_new = wish.orders.number != seen_.orders.number;
  input_.stamp = clock_.now();
  input_.goal_tolerance_m = rules_.tolerance_m;
  input_.goal_heading_tolerance_rad = rules_.heading_tolerance_rad;
  input_.stop_orders = wish.stops;
  input_.emergency_stop = wish.emergencies != seen_.emergencies;  // for one tick, as a reset
  if (wish.stops != seen_.stops) permission_.stop();
  const bool given = is_new && permission_.give(wish.orders);
  input_.reset = given && wish.orders.reset;
  if (given && wish.orders.here) {
    to_check_ = wish.orders;
    told_under_ = wish.orders.under;
  }
  told_place_.step(input_.stamp);
  seen_ = wish;
  head_for_goal();
  return input_;
}

void OperatorDesk::head_for_goal() noexcept {
  const GoalOrder* const goal = permission_.goal();
  input_.has_goal = goal != nullptr;
  if (goal == nullptr) return;
  input_.goal_in_map = goal->position_in_map;
  input_.goal_heading_rad = goal->heading_rad;
}

void OperatorDesk::tell(RunStatus& status) noexcept {
  permission_.note_rest(status.at_rest);
  if (!permission_.is_stopping()) status.stops_done = seen_.stops;
  if (!status.latched) status.latched_by = Reason::kNone;
  if (permission_.judge(status.reasons)) status.latched_by = without(status.reasons, kNoFaults);
  if (status.goal_reached && input_.has_goal) permission_.goal_is_reached();
  if (status.steered) permission_.give({.under = permission_.revoked()});
  status.revoked = permission_.revoked();
  status.goals_left = permission_.goals_left();
  head_for_goal();
  statuses_.publish(status);
}

}  // namespace jaywalk
