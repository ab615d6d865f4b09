#pragma once
#include <span>
#include <string_view>

#include "hil/faults/fault_bench.h"

namespace jaywalk::faults {

/// Every fault of the matrix, in the order in which it is printed. docs/explanation/safety.md says what each stands
/// for.
[[nodiscard]] std::span<const FaultCase> all_cases() noexcept;

}  // namespace jaywalk::faults
