#include "hil/faults/fault_matrix.h"

#include <array>

#include "hil/faults/fault_cases.h"

namespace jaywalk::faults {
namespace {

constexpr std::array kKinds{DriveKind::kCia402, DriveKind::kOdrive, DriveKind::kVesc, DriveKind::kPioneer};
constexpr std::array kSpeeds_mps{0.3, 0.6, 1.2};

template <class Visit>
void for_each_row(Visit&& visit) {
  for (const FaultCase& fault : all_cases()) {
    for (const DriveKind kind : kKinds) {
      if (fault.only && *fault.only != kind) continue;
      if (fault.of_bus && kind == DriveKind::kPioneer) continue;
      for (const double speed : kSpeeds_mps) visit(fault, kind, speed);
    }
  }
}

}  // namespace

int run_matrix(double rate_hz, const std::filesystem::path& folder,
               const std::function<void(const FaultResult&)>& tell) {
  int bad = 0;
  for_each_row([&](const FaultCase& fault, DriveKind kind, double speed_mps) {
    const FaultResult result = FaultBench(fault, kind, speed_mps, rate_hz, folder).suffer();
    bad += result.why_not.empty() ? 0 : 1;
    tell(result);
  });
  return bad;
}

}  // namespace jaywalk::faults
