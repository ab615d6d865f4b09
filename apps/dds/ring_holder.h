#pragma once
#include <filesystem>
#include <memory>

#include "drivers/ros/shared_ring.h"

namespace jaywalk::dds {

/// The ring that a robot's program made under a path, found again when another run has made it anew. Thread: one.
class RingHolder {
 public:
  RingHolder(std::filesystem::path path, const ros::SharedRing::Shape& shape) : path_(std::move(path)), shape_(shape) {}

  /// Null while no program has one there. Looks at the path every 50 ms.
  [[nodiscard]] ros::SharedRing* at(Time now) {
    constexpr Duration kLook = std::chrono::milliseconds(50);
    if (looked_ != kNever && now - looked_ < kLook) return ring_.get();
    looked_ = now;
    if (!ring_ || !ring_->is_current()) ring_ = ros::SharedRing::find(path_, shape_);
    return ring_.get();
  }

 private:
  std::filesystem::path path_;
  ros::SharedRing::Shape shape_;
  std::unique_ptr<ros::SharedRing> ring_;
  Time looked_ = kNever;
};

}  // namespace jaywalk::dds
