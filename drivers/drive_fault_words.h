#pragma once
#include <string>

#include "hal/types/errors.h"

namespace jaywalk {

/// Node, code and its meaning: "node 5: emergency 2310h (continuous over-current)"; empty where no fault was told. Not
/// for the loop.
[[nodiscard]] std::string describe(const DriveFault& fault);

/// Meanings of an ODrive's error bits, firmware 0.6, joined by "; "; empty for bits that are not known.
[[nodiscard]] std::string odrive_error_words(std::uint32_t errors);
/// Meanings of the bits of arcos::Fault, likewise.
[[nodiscard]] std::string arcos_fault_words(std::uint32_t faults);
/// Meaning of the procedure result in an ODrive's heartbeat: "timeout".
[[nodiscard]] std::string odrive_procedure_words(std::uint8_t result);

}  // namespace jaywalk
