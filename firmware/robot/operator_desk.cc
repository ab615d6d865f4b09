#include "firmware/robot/operator_desk.h"

#include "hal/types/errors.h"

namespace jaywalk {
namespace {

constexpr double kRest_mps = 0.01;

}  // namespace

std::string OperatorDesk::obey(std::string_view line) {
  const std::lock_guard lock(asking_);
  const RunStatus status = statuses_.latest();
  if (line == "status") return describe(status);
  if (line.starts_with("goto ")) return take_goal(line.substr(5), status);
  if (line == "reset") return take_reset(status);
  if (line != "stop" && line != "stop now")
    return "refused: not understood; say goto X Y [HEADING], stop, reset or status\n";
  ++wish_.number;
  wish_.has_goal = false;
  if (line == "stop now") ++wish_.emergencies;
  wishes_.publish(wish_);
  return "stopping\n";
}

std::string OperatorDesk::take_goal(std::string_view words, const RunStatus& status) {
  GoalOrder goal;
  try {
    goal = read_goal_order(words);
  } catch (const StartupError& error) {
    return std::string("refused: ") + error.what() + "\n";
  }
  if (closed_) return "refused: the run is ending\n";
  if (!status.running) return "refused: the robot is not ready yet; try again\n";
  if (status.latched && !status.proved && status.drive == DriveTrouble::kNone) {
    return "refused: the drives are being proved again; try again in some seconds\n";
  }
  if (status.latched) {
    return "refused: stopped by " + to_string(status.latched_by) + "; see to it, then jaywalk reset\n";
  }
  ++wish_.number;
  wish_.has_goal = true;
  wish_.goal = goal;
  wishes_.publish(wish_);
  return "going\n";
}

std::string OperatorDesk::take_reset(const RunStatus& status) {
  if (!status.latched) return "nothing to reset\n";
  if (status.bus.state == CanState::kBusOff) {  // first of all: off the bus nobody knows how fast the wheels are
    if (const std::string complaint = restart_bus_(); !complaint.empty()) return "refused: " + complaint + "\n";
    if (!bus_comes_back())
      return "refused: bus-off, and nobody is heard on the bus after a restart; see to the wires\n";
  }
  if (statuses_.latest().speed_mps > kRest_mps) return "refused: the robot still moves; try again when it stands\n";
  ++wish_.resets;
  wishes_.publish(wish_);
  return "reset\n";
}

bool OperatorDesk::bus_comes_back() {
  constexpr Duration kLongest = std::chrono::seconds(1), kLook = std::chrono::milliseconds(20);
  const Time limit = clock_.now() + kLongest;
  while (statuses_.latest().bus.state == CanState::kBusOff && clock_.now() < limit) {
    clock_.sleep_until(clock_.now() + kLook);
  }
  return statuses_.latest().bus.state != CanState::kBusOff;
}

void OperatorDesk::close() {
  const std::lock_guard lock(asking_);
  closed_ = true;
  ++wish_.number;
  wish_.has_goal = false;
  wishes_.publish(wish_);
}

OperatorInput OperatorDesk::latest() noexcept {
  const Wish& wish = wishes_.latest();
  if (wish.number != seen_.number) {
    input_.has_goal = wish.has_goal;
    input_.goal_in_map = wish.goal.position_in_map;
    input_.goal_heading_rad = wish.goal.heading_rad;
  }
  input_.stamp = clock_.now();
  input_.goal_tolerance_m = tolerances_.place_m;
  input_.goal_heading_tolerance_rad = tolerances_.heading_rad;
  input_.reset = wish.resets != seen_.resets;  // for one tick each
  input_.emergency_stop = wish.emergencies != seen_.emergencies;
  seen_ = wish;
  return input_;
}

void OperatorDesk::tell(const RunStatus& status) noexcept {
  if (status.latched || status.goal_reached) input_.has_goal = false;
  statuses_.publish(status);
}

}  // namespace jaywalk
