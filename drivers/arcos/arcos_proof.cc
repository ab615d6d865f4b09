// ArcosBase's arming proof: what the board is set to, and what it shows.
#include <algorithm>
#include <cmath>

#include "drivers/arcos/arcos_base.h"
#include "drivers/wired_drive.h"
#include "hal/shown_text.h"

namespace jaywalk::arcos {
namespace {

constexpr const char* kRampRemedy = "lower [limits] of the model, or raise the board's own limits (ARCOScfg)";

int in_ms(Duration time) { return static_cast<int>(time / std::chrono::milliseconds(1)); }

}  // namespace

/// The watchdog is the last.
std::array<ArcosBase::Compared, 9> ArcosBase::compared() const noexcept {
  const Settings& shown = *settings_;
  const MotionSettings& motion = setup_.motion;
  const int cycle_ms = static_cast<int>(std::lround(1e3 * setup_.times.report_s));
  const auto same = [](const char* name, int wanted, int shows, const char* remedy) {
    return Compared{name, wanted, wanted, shows, remedy};
  };
  return {same("SipCycle", cycle_ms, shown.cycle_ms, "write that as report_ms in [drive]"),
          same("TicksMM", setup_.ticks_per_mm, shown.ticks_per_mm, "write that as ticks_per_mm in [drive]"),
          same("TransAccel", motion.ramp_mmps2, shown.acceleration_mmps2, kRampRemedy),
          same("TransDecel", motion.ramp_mmps2, shown.deceleration_mmps2, kRampRemedy),
          same("RotAccel", motion.turn_ramp_dps2, shown.turn_acceleration_dps2, kRampRemedy),
          same("RotDecel", motion.turn_ramp_dps2, shown.turn_deceleration_dps2, kRampRemedy),
          same("TransVelMax", motion.top_mmps, shown.top_mmps, kRampRemedy),
          same("RotVelMax", motion.turn_top_dps, shown.turn_top_dps, kRampRemedy),
          {"Watchdog", in_ms(setup_.watchdog_least), in_ms(setup_.watchdog_most), shown.watchdog_ms,
           "set Watchdog in the board's FLASH (ARCOScfg), or allow_unproved at your own risk"}};
}

ProofResult ArcosBase::judge_settings() const noexcept {
  if (!is_pioneer()) return ProofResult::kFailed;
  const auto all = compared();
  const auto first_bad = std::ranges::find_if_not(all, &Compared::is_well);
  if (first_bad == all.end()) return ProofResult::kPassed;
  return first_bad + 1 == all.end() ? ProofResult::kUnproved : ProofResult::kFailed;
}

std::string ArcosBase::proof_line(std::size_t index) const {
  const std::string who = setup_.name + ": ";
  if (index == 1) {
    return who +
           formatted("%.0f reports a second%s, at most %.2f rad/s at commanded zero", shown_.per_second(),
                     counts_ ? " with encoders" : ", no encoders", shown_.fastest_radps()) +
           (faults_ == 0 ? "" : "; " + arcos_fault_words(faults_));
  }
  if (!settings_) return who + "does not tell its settings: NOT PROVED";
  std::string line = who + shown(settings_->type.data()) + " " + shown(settings_->subtype.data());
  if (!is_pioneer()) return line + ": is no Pioneer";
  bool well = true;
  for (const Compared& setting : compared()) {
    line += std::string(", ") + setting.name + " " + std::to_string(setting.shown);
    if (setting.is_well()) continue;
    well = false;
    line += " (wanted " + std::to_string(setting.least) +
            (setting.most != setting.least ? " to " + std::to_string(setting.most) : "") + ")";
  }
  return line + (well ? "" : ": NOT PROVED");
}

std::string ArcosBase::proof_remedy(std::size_t index) const {
  if (index == 1) {
    if (faults_ != 0) return "release the stop button, free the wheels, and begin anew";
    return shown_.is_often_enough() ? "see why the wheels turn" : shown_.remedy();
  }
  if (!settings_) return "see to its cable and its power";
  if (!is_pioneer()) return "this drive is for ARCOS boards of type Pioneer: P3-DX, P3-AT, PeopleBot";
  const auto all = compared();
  return std::ranges::find_if_not(all, &Compared::is_well)->remedy;
}

}  // namespace jaywalk::arcos
