#pragma once
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "drivers/panel/joystick.h"
#include "drivers/wired_drive.h"
#include "firmware/robot/control_socket.h"
#include "firmware/robot/goal_order.h"
#include "firmware/robot/place_check.h"
#include "firmware/robot/robot_file.h"
#include "firmware/robot/run_status.h"
#include "hal/hal.h"
#include "hal/mailbox.h"
#include "hal/types/map_zones.h"

namespace jaywalk {

/// What a robot's file says of goals.
struct GoalRules {
  double tolerance_m = OperatorInput{}.goal_tolerance_m;
  double heading_tolerance_rad = OperatorInput{}.goal_heading_tolerance_rad;
  std::vector<NamedPlace> places{};
  std::vector<MapZone> zones{};  ///< no goal lies in a keep-out zone, or nearer to one than a body of `body_m` stands
  double body_m = 0.0;
};

/// Operator panel that turns orders from the control socket into the loop's input, and the loop's status into answers.
/// Of a route it gives the loop one goal after the other, the next when one is reached.
///
/// A stop is obeyed to rest, and no goal is taken before. It drops the goal, as a latched fault, the stick and reaching
/// it do (Permission): it must be given anew, which a client that goes on repeating it does not (SaidGoals).
class OperatorDesk final : public OperatorPanel {
 public:
  /// Brings the drives' bus back from bus-off; what went wrong, or empty. Called in the asker's thread, may wait.
  using RestartBus = std::function<std::string()>;

  OperatorDesk(Clock& clock, GoalRules rules, RestartBus restart_bus)
      : clock_(clock), rules_(std::move(rules)), restart_bus_(std::move(restart_bus)) {}

  /// Any thread: obeys one line (control_socket.h) at once. What waits, for the bus or a place's check, is the reply's
  /// job, to be run in a thread that may wait.
  [[nodiscard]] ControlReply reply_to(std::string_view line);
  /// The same to the end: waits where reply_to() leaves a job.
  [[nodiscard]] std::string obey(std::string_view line);
  /// Any thread: no goal from now on, and none is taken any more.
  void close();

  /// Loop's thread.
  [[nodiscard]] OperatorInput latest() noexcept override;
  /// Loop's thread: what is permitted.
  [[nodiscard]] Permission& permission() noexcept { return permission_; }
  /// Loop's thread: a told place, to be held against the map; and the answer.
  [[nodiscard]] std::optional<Orders> place_to_check() noexcept { return std::exchange(to_check_, {}); }
  void answer_place(const PlaceAnswer& answer) noexcept {
    if (answer.is_taken() && permission_.revoked() == told_under_) told_place_.tell(answer.map_from_robot);
  }
  /// Loop's thread: where people say that the robot is.
  [[nodiscard]] PoseSource& told_place() noexcept { return told_place_; }
  /// Loop's thread, after a tick: how it went. Adds what of the status the desk knows: of goals, and by what it stands.
  void tell(RunStatus& status) noexcept;

 private:
  struct Wish {
    std::uint32_t stops = 0;
    std::uint32_t emergencies = 0;
    Orders orders{};  ///< the newest
  };

  [[nodiscard]] RunStatus status();
  [[nodiscard]] std::string take_stop(bool now);
  /// Under the lock: takes the place of what was asked for before.
  void wish(const Orders& orders);
  /// Under the lock: until the newest order to stop was obeyed to rest.
  [[nodiscard]] bool is_stopping(const RunStatus& status) const { return status.stops_done != wish_.stops; }
  /// Under the lock: why no goal is taken now; empty where one is.
  [[nodiscard]] std::string goals_are_refused(const RunStatus& status) const;
  /// Loop's thread: the goal that is permitted, or none.
  void head_for_goal() noexcept;
  /// These throw StartupError for words that are no place.
  [[nodiscard]] std::string take_goal(std::string_view words);
  /// It drops the goal: at rest only.
  [[nodiscard]] ControlReply take_place(std::string_view words);
  /// In a thread that may wait. `under`: revocations when `order` was given.
  [[nodiscard]] std::string answer_to_place(std::uint32_t order, std::uint32_t under);
  [[nodiscard]] ControlReply take_reset();
  /// In a thread that may wait. `stops`: how many there were when the reset was asked for.
  [[nodiscard]] std::string restart_bus_and_reset(std::uint32_t stops);
  /// Under the lock: presses reset for the loop.
  [[nodiscard]] std::string reset_at_rest(const RunStatus& status);
  /// In a thread that may wait: the status as soon as it `holds`, after `longest` at most.
  [[nodiscard]] RunStatus await(Duration longest, const std::function<bool(const RunStatus&)>& holds);

  Clock& clock_;
  GoalRules rules_;
  RestartBus restart_bus_;
  std::mutex asking_;  ///< never the loop's, and never held while something waits
  bool closed_ = false;
  Wish wish_;       ///< the askers'
  SaidGoals said_;  ///< likewise
  Mailbox<Wish> wishes_;
  Mailbox<RunStatus> statuses_;
  Wish seen_;  ///< the loop's
  Permission permission_;
  ToldPlace told_place_;
  std::optional<Orders> to_check_;
  std::uint32_t told_under_ = 0;  ///< revocations when it was given
  OperatorInput input_;
};

/// An operator panel in front of another: its stick counts as far as it is permitted (Permission::admitted()), and its
/// reset edge, at rest, resets the drives. Where they were in trouble that begins their whole proof (SAFETY 15), and
/// the reset reaches the loop once both have passed it, unless a stop, fault or order voids it. Thread: the loop's.
class ResetGate final : public OperatorPanel {
 public:
  /// All outlive it.
  ResetGate(OperatorPanel& panel, Permission& permission, WiredDrive& drive) noexcept
      : panel_(panel), permission_(permission), drive_(drive) {}

  [[nodiscard]] OperatorInput latest() noexcept override;
  /// After each tick: whether a wheel is felt turning. There is no reset then.
  void note_turning(bool turns) noexcept { turns_ = turns; }

 private:
  OperatorPanel& panel_;
  Permission& permission_;
  WiredDrive& drive_;
  bool turns_ = false;
  bool reset_before_ = false;
};

/// What people have in their hands: the desk behind the control socket and, where the file has one, a joystick in front
/// of it. Their resets wait until the drives are proved.
class OperatorControls {
 public:
  /// `drive` and `clock` outlive it.
  OperatorControls(const RobotFile& file, WiredDrive& drive, Clock& clock, OperatorDesk::RestartBus restart_bus);

  /// Start-up only: starts the joystick's thread (priority of SCHED_FIFO; 0: ordinary). Throws as refuse_unrenewed().
  void start(int priority);
  /// What the thread does: by hand where none was started.
  void step() noexcept {
    if (watch_) watch_->step();
  }

  [[nodiscard]] OperatorDesk& desk() noexcept { return desk_; }
  /// What the loop sees.
  [[nodiscard]] OperatorPanel& panel() noexcept { return *gate_; }
  [[nodiscard]] ResetGate& resets() noexcept { return *gate_; }

 private:
  OperatorDesk desk_;
  std::optional<panel::JoystickSetup> wiring_;
  std::optional<panel::JoystickWatch> watch_;
  std::optional<panel::JoystickPanel> joystick_;
  std::optional<ResetGate> gate_;
};

/// Throws StartupError for a dead man that could stay held when its link has died.
void refuse_unrenewed(const panel::JoystickState& state, const panel::JoystickSetup& wiring);

}  // namespace jaywalk
