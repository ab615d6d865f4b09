#pragma once
// Mode paper and the rival planners, of the desktop program alone.
#include <memory>

#include "firmware/backends.h"
#include "planner/paper/map_field.h"
#include "planner/paper/paper.h"

namespace jaywalk {

/// Gives a setup the motion and planner that its mode and rival name. Throws nothing.
void equip(ControlSetup& setup) noexcept;

/// The potential of a map alone, on the backend that make_planner() would take, without trial and fall-back. Throws
/// StartupError where kCuda cannot be had.
[[nodiscard]] std::unique_ptr<paper::MapField> make_map_field(const paper::CellMap& map, Backend backend,
                                                              int device = 0);
/// The paper's planner on the backend that make_planner() would take, without trial.
[[nodiscard]] ChosenPlanner make_paper_planner(const paper::PaperConfig& config, Backend backend, int device = 0);

}  // namespace jaywalk
