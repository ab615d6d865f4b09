#pragma once
#include "planner/tracking/bodies.h"

namespace jaywalk {

/// Whether a body that is not seen is no track any more: beams have passed through where it should be, or it has been
/// away for longer than somebody who walked, stood or was not believed yet may be.
[[nodiscard]] bool gone(const Body& body, Time now) noexcept;

}  // namespace jaywalk
