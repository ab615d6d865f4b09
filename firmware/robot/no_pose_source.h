#pragma once
#include "hal/hal.h"

namespace jaywalk {

/// A robot without a localisation system outside it.
class NoPoseSource final : public PoseSource {
 public:
  [[nodiscard]] const OutsideFix& latest() noexcept override { return none_; }

 private:
  OutsideFix none_;
};

}  // namespace jaywalk
