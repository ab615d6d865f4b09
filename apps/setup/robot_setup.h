#pragma once
// `jaywalk setup`: finds a robot's devices, asks what cannot be seen, and drafts its ROBOT.toml.
#include "apps/setup/robot_draft.h"
#include "apps/setup/setup_answers.h"
#include "apps/setup/surroundings.h"
#include "hal/hal.h"

namespace jaywalk {

/// Nothing moves, and no device's setting is changed but what makes a scanner send. What the answers name is looked for
/// there alone. Takes some seconds, up to ten. Throws StartupError where the drives or a key are not to be known.
[[nodiscard]] RobotDraft draft_robot(Surroundings& machine, SetupAnswers& answers, Clock& clock);

}  // namespace jaywalk
