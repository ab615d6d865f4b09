#include "hal/sim/stick.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <string>

#include "hal/shown_text.h"
#include "hal/sim/simulation.h"
#include "hal/text_file.h"
#include "hal/types/trig.h"

namespace jaywalk::sim {
namespace {

constexpr double kTremble_s = 0.5;   ///< correlation time of a hand
constexpr double kLeftPerRad = 1.2;  ///< of the stick's way, a radian off the goal
constexpr double kTurnsFirst_rad = 1.0;
constexpr double kArrived = 0.5;  ///< of the goal's tolerance: then the hand lets go
constexpr std::size_t kRemembered = 1024;
constexpr const char* kStickRows =
    "write rows of t_s,forward,left below a line that says so; forward and left -1 to 1, times rising";

}  // namespace

ScriptedStick::ScriptedStick(const StickSpec& spec, const Scenario& scenario, std::uint64_t seed)
    : spec_(spec),
      goal_(scenario.goal),
      arrives_within_m_(kArrived * scenario.goal_tolerance_m),
      meant_(kRemembered),
      random_(seed, Purpose::kStick) {
  if (spec.kind != StickKind::kTable) return;
  std::ifstream in(spec.file);
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (number == 1) {
      drop_byte_order_mark(line);
      if (line != "t_s,forward,left") refuse_line(spec.file, 1, "does not begin with t_s,forward,left", kStickRows);
      continue;
    }
    if (line.empty()) continue;
    std::string words = line, rest;
    std::replace(words.begin(), words.end(), ',', ' ');
    std::istringstream numbers(words);
    Row row;
    const bool whole =
        static_cast<bool>(numbers >> row.t_s >> row.stick.forward >> row.stick.left) && !(numbers >> rest);
    const bool rises = table_.empty() || row.t_s > table_.back().t_s;
    if (!whole || !rises || !(std::fabs(row.stick.forward) <= 1.0) || !(std::fabs(row.stick.left) <= 1.0))
      refuse_line(spec.file, number, "\"" + shown(line) + "\" is no row of it", kStickRows);
    table_.push_back(row);
  }
  if (table_.empty()) refuse_line(spec.file, 0, "holds no row", kStickRows);
}

Stick ScriptedStick::at(const Truth& truth) noexcept {
  const double now_s = to_seconds(truth.now);
  tremble(now_s - before_s_);
  before_s_ = now_s;
  meant_[next_++ % kRemembered] = {now_s, meant(truth)};
  Stick stick = delayed(now_s);
  if (stick.is_centred()) return stick;
  stick.forward = std::clamp(stick.forward + off_forward_, -1.0, 1.0);
  stick.left = std::clamp(stick.left + off_left_, -1.0, 1.0);
  return stick;
}

Stick ScriptedStick::meant(const Truth& truth) const noexcept {
  if (spec_.kind == StickKind::kStraight) return {spec_.forward, 0.0};
  if (spec_.kind == StickKind::kToGoal) return meant_to_goal(truth);
  const auto after = std::find_if(table_.begin(), table_.end(),
                                  [now_s = to_seconds(truth.now)](const Row& row) { return row.t_s > now_s; });
  return after == table_.begin() ? Stick{} : std::prev(after)->stick;
}

/// Points at the goal as if nothing were in between.
Stick ScriptedStick::meant_to_goal(const Truth& truth) const noexcept {
  const Vec2 to = goal_ - truth.map_from_robot.position();
  if (norm(to) < arrives_within_m_) return {};
  const double off = wrap_angle(atan2(to.y, to.x) - truth.map_from_robot.heading);
  const double ahead = std::fabs(off) < kTurnsFirst_rad ? spec_.forward : 0.0;
  return {ahead, std::clamp(kLeftPerRad * off, -1.0, 1.0)};
}

/// The newest that was meant spec_.delay_s ago or before; nothing before the first.
Stick ScriptedStick::delayed(double now_s) noexcept {
  for (std::size_t back = 1; back <= std::min(next_, kRemembered); ++back) {
    const Row& row = meant_[(next_ - back) % kRemembered];
    if (row.t_s <= now_s - spec_.delay_s) return row.stick;
  }
  return {};
}

/// Ornstein and Uhlenbeck's process, a share of the stick's way.
void ScriptedStick::tremble(double dt_s) noexcept {
  if (spec_.noise_std <= 0.0 || dt_s <= 0.0) return;
  const double keeps = std::max(0.0, 1.0 - dt_s / kTremble_s), adds = spec_.noise_std * std::sqrt(1.0 - keeps * keeps);
  off_forward_ = keeps * off_forward_ + adds * random_.normal();
  off_left_ = keeps * off_left_ + adds * random_.normal();
}

}  // namespace jaywalk::sim
