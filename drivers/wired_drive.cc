#include "drivers/wired_drive.h"

#include <algorithm>
#include <span>

#include "drivers/arcos/arcos_base.h"
#include "hal/shown_text.h"

namespace jaywalk {
namespace {

struct CodeMeaning {
  std::uint32_t code;
  const char* words;
};

// CiA 301 and 402, error codes of emergency messages; the others are named by their class.
constexpr std::array kEmergencies{CodeMeaning{0x2310, "continuous over-current"},
                                  CodeMeaning{0x2320, "short circuit"},
                                  CodeMeaning{0x2330, "earth leakage"},
                                  CodeMeaning{0x3110, "mains over-voltage"},
                                  CodeMeaning{0x3120, "mains under-voltage"},
                                  CodeMeaning{0x3210, "DC link over-voltage"},
                                  CodeMeaning{0x3220, "DC link under-voltage"},
                                  CodeMeaning{0x4210, "device too hot"},
                                  CodeMeaning{0x4310, "drive too hot"},
                                  CodeMeaning{0x5112, "supply under-voltage"},
                                  CodeMeaning{0x5530, "stored settings damaged"},
                                  CodeMeaning{0x7121, "motor blocked"},
                                  CodeMeaning{0x7122, "motor or commutation"},
                                  CodeMeaning{0x7300, "sensor"},
                                  CodeMeaning{0x7305, "encoder"},
                                  CodeMeaning{0x8110, "CAN overrun"},
                                  CodeMeaning{0x8120, "CAN error passive"},
                                  CodeMeaning{0x8130, "controller's heartbeat missed"},
                                  CodeMeaning{0x8140, "back from bus-off"},
                                  CodeMeaning{0x8611, "following error"}};

/// Classes of emergencies by the highest digit of their code (CiA 301).
constexpr std::array kEmergencyClasses{"no error",    "generic",         "current",         "voltage",
                                       "temperature", "device hardware", "device software", "additional modules",
                                       "monitoring",  "external",        "reserved",        "reserved",
                                       "reserved",    "reserved",        "reserved",        "device specific"};

// mc_fault_code of the VESC firmware.
constexpr std::array kVescFaults{"none",
                                 "over-voltage",
                                 "under-voltage",
                                 "gate driver",
                                 "over-current",
                                 "power stage too hot",
                                 "motor too hot",
                                 "gate driver over-voltage",
                                 "gate driver under-voltage",
                                 "processor under-voltage",
                                 "restarted by its watchdog",
                                 "encoder's line",
                                 "encoder's signal too small",
                                 "encoder's signal too large",
                                 "flash damaged",
                                 "offset of current sensor 1",
                                 "offset of current sensor 2",
                                 "offset of current sensor 3",
                                 "unbalanced currents",
                                 "brake",
                                 "resolver lost tracking",
                                 "resolver degraded",
                                 "resolver lost signal",
                                 "application settings damaged",
                                 "motor settings damaged",
                                 "encoder without magnet",
                                 "encoder's magnet too strong",
                                 "phase filter"};

// ODrive.Error of firmware 0.6.
constexpr std::array kOdriveErrors{CodeMeaning{0x00000001, "starting up"},
                                   CodeMeaning{0x00000002, "system"},
                                   CodeMeaning{0x00000004, "timing"},
                                   CodeMeaning{0x00000008, "no encoder estimate"},
                                   CodeMeaning{0x00000010, "bad configuration"},
                                   CodeMeaning{0x00000020, "gate driver"},
                                   CodeMeaning{0x00000040, "no input"},
                                   CodeMeaning{0x00000100, "DC bus over-voltage"},
                                   CodeMeaning{0x00000200, "DC bus under-voltage"},
                                   CodeMeaning{0x00000400, "DC bus over-current"},
                                   CodeMeaning{0x00000800, "too much regenerated current"},
                                   CodeMeaning{0x00001000, "current limit"},
                                   CodeMeaning{0x00002000, "motor too hot"},
                                   CodeMeaning{0x00004000, "inverter too hot"},
                                   CodeMeaning{0x00008000, "velocity limit"},
                                   CodeMeaning{0x00010000, "position limit"},
                                   CodeMeaning{0x01000000, "watchdog expired"},
                                   CodeMeaning{0x02000000, "emergency stop asked for"},
                                   CodeMeaning{0x04000000, "encoder spun out"},
                                   CodeMeaning{0x08000000, "brake resistor off"},
                                   CodeMeaning{0x10000000, "thermistor missing"},
                                   CodeMeaning{0x40000000, "calibration"}};

// ODrive.ProcedureResult of firmware 0.6.
constexpr std::array kOdriveProcedures{"success",
                                       "busy",
                                       "cancelled",
                                       "disarmed",
                                       "no response",
                                       "pole pairs and encoder counts do not match",
                                       "phase resistance out of range",
                                       "phase inductance out of range",
                                       "unbalanced phases",
                                       "invalid motor type",
                                       "illegal Hall state",
                                       "timeout",
                                       "homing without end switch",
                                       "invalid state",
                                       "not calibrated",
                                       "does not converge"};

constexpr std::array kArcosFaults{
    CodeMeaning{arcos::kLeftStall, "left wheel stalled"}, CodeMeaning{arcos::kRightStall, "right wheel stalled"},
    CodeMeaning{arcos::kStopButton, "stop button pressed"}, CodeMeaning{arcos::kMotorStall, "E_stall"}};

const char* word_at(std::span<const char* const> words, std::size_t index) {
  return index < words.size() ? words[index] : "not known";
}

/// Of each bit that is set, joined by "; ".
std::string words_of(std::span<const CodeMeaning> meanings, std::uint32_t bits) {
  std::string words;
  for (const CodeMeaning& meaning : meanings)
    if ((bits & meaning.code) != 0) words += (words.empty() ? "" : "; ") + std::string(meaning.words);
  return words;
}

std::string emergency_words(std::uint32_t code) {
  const auto* found = std::ranges::find(kEmergencies, code, &CodeMeaning::code);
  return found != kEmergencies.end() ? found->words : kEmergencyClasses[code >> 12U & 0xFU];
}

}  // namespace

void require_axes(const std::array<CanAxis, 2>& axes, const std::string& kind, int lowest, int highest, int own) {
  for (const auto& [node, per_rad] : axes) {
    const bool fits = node >= lowest && node <= highest && node != own;
    if (fits && std::isfinite(per_rad) && per_rad != 0.0) continue;
    throw StartupError(kind + " " + std::to_string(node) + ": cannot be set up so",
                       "give it a number from " + std::to_string(lowest) + " to " + std::to_string(highest) +
                           " other than the controller's, and its units per radian");
  }
  if (axes[0].node == axes[1].node)
    throw StartupError(kind + " " + std::to_string(axes[0].node) + ": stands for both wheels", "give each its own");
}

std::string odrive_error_words(std::uint32_t errors) { return words_of(kOdriveErrors, errors); }

std::string arcos_fault_words(std::uint32_t faults) { return words_of(kArcosFaults, faults); }

std::string odrive_procedure_words(std::uint8_t result) { return word_at(kOdriveProcedures, result); }

std::string describe(const DriveFault& fault) {
  const std::string node = std::to_string(fault.node) + ": ", number = std::to_string(fault.code);
  const auto code = static_cast<unsigned>(fault.code);
  switch (fault.kind) {
    case DriveFaultKind::kEmergency:
      return "node " + node + "emergency " + formatted("%04Xh", code) + " (" + emergency_words(fault.code) + ")";
    case DriveFaultKind::kMode:
      return "node " + node + "mode " + number + " in 6061h since it was enabled, not profile velocity (3)";
    case DriveFaultKind::kOdrive:
      return "ODrive node " + node + "error " + formatted("%08Xh", code) + " (" + odrive_error_words(fault.code) + ")";
    case DriveFaultKind::kVesc:
      return "VESC " + node + "fault " + number + " (" + word_at(kVescFaults, fault.code) + ")";
    case DriveFaultKind::kVescStill:
      return "VESC " + node + "told " + number +
             " ERPM, and its motor does not turn: blocked, or its minimum ERPM lies above; set that to 0 (VESC Tool, "
             "Motor Settings, PID Controllers)";
    case DriveFaultKind::kArcos: return "Pioneer: " + arcos_fault_words(fault.code);
    case DriveFaultKind::kNone: break;
  }
  return "";
}

StopLimits stop_limits(double brake_radps2, double tolerance_radps, Duration tick, const DriveTimes& drive) noexcept {
  StopLimits limits{.brake_radps2 = brake_radps2, .tolerance_radps = tolerance_radps};
  const Duration slower = duration_from_seconds(drive.slower_s(to_seconds(tick)));
  limits.response = std::max<Duration>(limits.response, std::chrono::milliseconds(20) + 2 * tick) + slower;
  limits.fresh = std::max({limits.fresh, 5 * tick / 2, duration_from_seconds(drive.oldest_report_s())});
  limits.tick = tick;
  limits.confirmation += slower;
  return limits;
}

StopStage StopLadder::update(Time now, bool stopping, bool trouble,
                             const std::array<WheelFeedback, 2>& wheels) noexcept {
  follow_orders(now, wheels);
  if (!stopping && stage_ == StopStage::kNone) {
    under_way_ = ended_ = false;
    return stage_;
  }
  // A stop that this ladder itself made trouble of is under way already.
  const bool new_trouble = trouble && !trouble_ && stage_ == StopStage::kNone;
  trouble_ = trouble_ || trouble;
  // Trouble that comes into a stop under way gives it no time anew.
  if (new_trouble && under_way_) stage_ = StopStage::kQuickStop;
  if (!under_way_ && (!ended_ || new_trouble)) begin(now, wheels);
  if (!under_way_) return stage_;
  if (!trouble_ && stage_ == StopStage::kNone && is_at_rest(now, wheels)) {
    under_way_ = false;
    ended_ = true;
    return stage_;
  }
  if (is_over(now) && !confirmed_) {
    confirmed_ = is_at_rest(now, wheels);
    if (!confirmed_) stage_ = StopStage::kSilent;
  }
  if (now - ordered_ > limits_.response && !is_kept(now, wheels)) climb(now);
  return stage_;
}

// What a wheel was told holds until now; what it is told in this cycle counts from now on.
void StopLadder::follow_orders(Time now, const std::array<WheelFeedback, 2>& wheels) noexcept {
  const bool is_first = followed_ == kNever;
  const double braked = is_first ? 0.0 : limits_.brake_radps2 * to_seconds(now - followed_);
  followed_ = now;
  for (std::size_t k = 0; k < wheels.size(); ++k) {
    const double told = std::fabs(wheels[k].told_radps);
    owed_radps_[k] = std::max(is_first ? told : told_radps_[k], owed_radps_[k] - braked);
    told_radps_[k] = told;
  }
}

void StopLadder::begin(Time now, const std::array<WheelFeedback, 2>& wheels) noexcept {
  under_way_ = true;
  ended_ = false;
  ordered_ = now;
  for (std::size_t k = 0; k < wheels.size(); ++k)
    speed_at_order_[k] = std::min(std::fabs(wheels[k].speed_radps), owed_radps_[k]);
  longest_s_ =
      std::max(speed_at_order_[0], speed_at_order_[1]) / limits_.brake_radps2 + to_seconds(limits_.confirmation);
  confirmed_ = false;
  // The drives are told to quick-stop at once where there is trouble.
  if (trouble_) stage_ = std::max(stage_, StopStage::kQuickStop);
}

// Written so that a ramp that is no number is over.
bool StopLadder::is_over(Time now) const noexcept { return !(to_seconds(now - ordered_) <= longest_s_); }

bool StopLadder::is_kept(Time now, const std::array<WheelFeedback, 2>& wheels) const noexcept {
  const double braked = limits_.brake_radps2 * to_seconds(now - ordered_ - limits_.response);
  for (std::size_t k = 0; k < wheels.size(); ++k) {
    const double most = std::max(speed_at_order_[k] - braked, 0.0) + limits_.tolerance_radps;
    // Written so that a speed that is no number is not kept.
    if (!is_fresh(now, wheels[k]) || !(std::fabs(wheels[k].speed_radps) <= most)) return false;
  }
  return true;
}

bool StopLadder::is_at_rest(Time now, const std::array<WheelFeedback, 2>& wheels) const noexcept {
  return std::all_of(wheels.begin(), wheels.end(), [&](const WheelFeedback& wheel) {
    return is_fresh(now, wheel) && std::fabs(wheel.speed_radps) <= limits_.tolerance_radps;
  });
}

void StopLadder::climb(Time now) noexcept {
  if (stage_ == StopStage::kSilent || age(climbed_, now) < limits_.stage) return;
  stage_ = static_cast<StopStage>(static_cast<int>(stage_) + 1);
  // The network stop comes with a quick stop: it waits for no cycle that would be silent.
  if (!confirmed_ && is_over(now + limits_.tick)) stage_ = std::max(stage_, StopStage::kNetworkStop);
  climbed_ = now;
}

}  // namespace jaywalk
