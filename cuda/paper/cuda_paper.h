#pragma once
// The paper's planner and the potential of a map on a CUDA device: the bits of the CPU's.
#include <chrono>
#include <memory>
#include <string>

#include "cuda/cuda_planner.h"
#include "planner/paper/map_field.h"
#include "planner/paper/paper.h"

namespace jaywalk::paper {

/// The paper's planner on a device; null and `why_not` as make_cuda_planner() has them.
[[nodiscard]] std::unique_ptr<Planner> make_cuda_paper_planner(const PaperConfig& config, int device,
                                                               std::string& why_not,
                                                               std::chrono::milliseconds limit = kLongestWait);

/// Potential of a map alone, likewise.
[[nodiscard]] std::unique_ptr<MapField> make_cuda_map_field(CellMap map, int device, std::string& why_not);

}  // namespace jaywalk::paper
