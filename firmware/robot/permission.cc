#include "firmware/robot/permission.h"

#include <utility>

namespace jaywalk {

bool Permission::judge(Reason reasons) noexcept {
  const bool latched = has(reasons, Reason::kLatched);
  const Reason faults = without(reasons, kNoFaults);
  const bool rises = without(faults, std::exchange(faults_, faults)) != Reason::kNone;
  const bool begins = !std::exchange(latched_, latched) && latched;
  if (begins || (latched && rises)) revoke();
  return std::exchange(revokes_reset_, false) || begins;
}

}  // namespace jaywalk
