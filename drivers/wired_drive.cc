#include "drivers/wired_drive.h"

#include <span>

#include "drivers/arcos/arcos.h"
#include "drivers/canopen/cia402.h"
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
  return found != kEmergencies.end() ? found->words
                                     : std::string(canopen::emergency_class(static_cast<std::uint16_t>(code)));
}

std::string coded(const char* format, std::uint32_t number) { return formatted(format, static_cast<unsigned>(number)); }

}  // namespace

void require_axes(const std::array<CanAxis, 2>& axes, const AxisNumbers& numbers) {
  const std::string kind = numbers.kind;
  for (const auto& [node, per_rad] : axes) {
    const bool fits = node >= numbers.lowest && node <= numbers.highest && node != numbers.own;
    if (fits && std::isfinite(per_rad) && per_rad != 0.0) continue;
    throw StartupError(kind + " " + std::to_string(node) + ": cannot be set up so",
                       "give it a number from " + std::to_string(numbers.lowest) + " to " +
                           std::to_string(numbers.highest) + " other than the controller's, and its units per radian");
  }
  if (axes[0].node == axes[1].node)
    throw StartupError(kind + " " + std::to_string(axes[0].node) + ": stands for both wheels", "give each its own");
}

std::string odrive_error_words(std::uint32_t errors) { return words_of(kOdriveErrors, errors); }

std::string arcos_fault_words(std::uint32_t faults) { return words_of(kArcosFaults, faults); }

std::string odrive_procedure_words(std::uint8_t result) { return word_at(kOdriveProcedures, result); }

std::string describe(const DriveFault& fault) {
  const std::string node = std::to_string(fault.node) + ": ", number = std::to_string(fault.code);
  switch (fault.kind) {
    case DriveFaultKind::kEmergency:
      return "node " + node + "emergency " + coded("%04Xh", fault.code) + " (" + emergency_words(fault.code) + ")";
    case DriveFaultKind::kMode:
      return "node " + node + "mode " + number + " in 6061h since it was enabled, not profile velocity (3)";
    case DriveFaultKind::kOdrive:
      return "ODrive node " + node + "error " + coded("%08Xh", fault.code) + " (" + odrive_error_words(fault.code) +
             ")";
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

}  // namespace jaywalk
