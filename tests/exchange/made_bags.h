#pragma once
// Small recordings in the formats of ROS's tools, made from their specifications and not with the writers of the
// program.
#include <cstdint>
#include <string>
#include <vector>

#include "apps/formats/bag_file.h"

namespace jaywalk::tests {

struct MadeMessage {
  std::string topic, type;  ///< "sensor_msgs/LaserScan"
  std::int64_t ns = 0;
  std::string bytes;
};

/// `method`: "", "zstd", "lz4", "bz2".
[[nodiscard]] std::string packed(const std::string& method, const std::string& bytes);

/// What a scan says of its beams: 90 degrees apart from 0 on where nothing else is given.
struct MadeFan {
  float step_rad = 1.57079637F, beam_step_s = 0.0F, range_min_m = 0.05F, range_max_m = 25.0F;
};
[[nodiscard]] std::string scan_bytes(bool ros1, std::int64_t ns, const std::string& frame, std::vector<float> ranges,
                                     const MadeFan& fan = {});
[[nodiscard]] std::string odometry_bytes(bool ros1, std::int64_t ns, double x, double v_mps = 1.0,
                                         const std::string& child = "base_link", double quaternion_w = 1.0);
struct MadeFrame {
  std::string parent, child;
  double x = 0.0, y = 0.0;
  double quaternion[4] = {0.0, 0.0, 0.0, 1.0};  ///< x, y, z, w
};
[[nodiscard]] std::string frames_bytes(bool ros1, const std::vector<MadeFrame>& frames);

/// Ten scans and ten poses 0.1 m apart, and the laser 0.2 m ahead of the robot's middle.
[[nodiscard]] std::vector<MadeMessage> made_drive(bool ros1);

/// made_drive() in Foxglove's messages, in protobuf, the laser 0.1 m to the left; four beams a scan, 1 rad apart.
[[nodiscard]] std::vector<MadeMessage> made_foxglove_drive();

/// A type without "/" is Foxglove's, in protobuf. `pack_each`: messages packed one by one with zstd, as rosbag2's
/// compression_mode "message" does.
[[nodiscard]] std::string mcap_of(const std::vector<MadeMessage>& messages, const std::string& method,
                                  bool pack_each = false);
/// `behind`: bytes behind each chunk, where the format has its index; two chunks where there are any.
[[nodiscard]] std::string ros1_bag_of(const std::vector<MadeMessage>& messages, const std::string& method,
                                      const std::string& behind = "");
/// An index record of `entries` that says `claimed` bytes and has `entries` * 12.
[[nodiscard]] std::string ros1_index(std::size_t entries, std::size_t claimed);
void write_sqlite(const std::string& file, const std::vector<MadeMessage>& messages, bool pack_each);

/// The log that an MCAP file of the messages is read as.
[[nodiscard]] sim::RecordedLog read_as_mcap(const std::vector<MadeMessage>& messages,
                                            const exchange::BagOptions& options = {});

/// Gives each message of a topic other bytes, of its time and its number from 0.
template <class Bytes>
void rewrite(std::vector<MadeMessage>& messages, const std::string& topic, const Bytes& bytes_of) {
  int number = 0;
  for (MadeMessage& message : messages)
    if (message.topic == topic) message.bytes = bytes_of(message.ns, number++);
}

}  // namespace jaywalk::tests
