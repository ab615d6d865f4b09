#pragma once
// Foxglove's own messages in protobuf (github.com/foxglove/foxglove-sdk, schemas/proto), as far as a replay needs them.
#include <optional>
#include <string_view>
#include <vector>

#include "apps/formats/ros_input.h"

namespace jaywalk::exchange {

/// foxglove.LaserScan: it says no range limits (0 to infinity here) and no times of beams, but where its origin lies in
/// its frame. Nothing where the bytes are no such message.
[[nodiscard]] std::optional<ScanMessage> read_foxglove_scan(std::string_view bytes);
/// foxglove.FrameTransform.
[[nodiscard]] std::optional<TransformMessage> read_foxglove_transform(std::string_view bytes);
/// foxglove.FrameTransforms.
[[nodiscard]] std::optional<std::vector<TransformMessage>> read_foxglove_transforms(std::string_view bytes);

}  // namespace jaywalk::exchange
