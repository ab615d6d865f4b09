#include "apps/formats/bag_log.h"

#include <cstdio>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "apps/formats/bag_file.h"
#include "apps/formats/laser_mount.h"
#include "apps/formats/logs/log_checks.h"
#include "apps/formats/ros_input.h"
#include "hal/shown_text.h"
#include "hal/types/errors.h"

namespace jaywalk::exchange {
namespace {

constexpr const char* kScans = "sensor_msgs/LaserScan";
constexpr const char* kOdometry = "nav_msgs/Odometry";

/// All that a replay could need of a recording, by topic.
struct BagContents {
  std::map<std::string, std::vector<ScanMessage>> scans;
  std::map<std::string, std::vector<OdometryMessage>> odometry;
  FrameTree frames;
  std::map<std::string, std::string> others;  ///< topics of other types, with those
};

class Collector {
 public:
  Collector(std::string file, BagContents& found) : file_(std::move(file)), found_(found) {}

  void operator()(const BagMessage& message) {
    const std::string topic(message.topic);
    if (message.type == kScans) {
      take(read_scan(message.bytes, message.wire), found_.scans[topic], message);
    } else if (message.type == kOdometry) {
      take(read_odometry(message.bytes, message.wire), found_.odometry[topic], message);
    } else if (message.type == "tf2_msgs/TFMessage" || message.type == "tf/tfMessage") {
      std::vector<std::vector<TransformMessage>> transforms;
      take(read_transforms(message.bytes, message.wire), transforms, message);
      for (const TransformMessage& transform : transforms.front()) found_.frames.add(transform);
    } else {
      found_.others.emplace(topic, message.type);
    }
  }

 private:
  template <class Read>
  void take(std::optional<Read> read, std::vector<Read>& list, const BagMessage& message) {
    const std::size_t number = ++numbers_[std::string(message.topic)];
    if (!read) {
      sim::LogPlace{file_ + ": " + shown(message.topic), number, "message"}.refuse(
          "its bytes are no " + std::string(message.type), "record it again, or give another topic");
    }
    if constexpr (requires { read->stamp; }) {
      if (read->stamp == Time{}) read->stamp = message.logged;
    }
    list.push_back(std::move(*read));
  }

  std::string file_;
  BagContents& found_;
  std::map<std::string, std::size_t> numbers_;
};

/// "/a (nav_msgs/Path), /b (...)", the first dozen.
std::string listed(const std::map<std::string, std::string>& topics) {
  constexpr std::size_t kMost = 12;
  std::string text;
  std::size_t told = 0;
  for (const auto& [topic, type] : topics) {
    if (++told > kMost) return text + ", and " + std::to_string(topics.size() - kMost) + " more";
    text += (text.empty() ? "" : ", ") + shown(topic) + " (" + shown(type) + ")";
  }
  return text.empty() ? "none" : text;
}

template <class Messages>
std::string names_of(const std::map<std::string, Messages>& topics) {
  std::string text;
  for (const auto& topic : topics) text += (text.empty() ? "" : ", ") + shown(topic.first);
  return text;
}

/// The topic to read: `wanted`, or the only one; empty where there is none and none is wanted.
template <class Messages>
std::string choose(const std::string& file, const std::map<std::string, Messages>& topics, const std::string& wanted,
                   const std::string& option, const char* type) {
  if (!wanted.empty() && topics.count(wanted) == 0) {
    throw StartupError(file + ": no topic " + shown(wanted) + " of type " + type,
                       topics.empty() ? "there is none of that type" : "there are " + names_of(topics));
  }
  if (!wanted.empty() || topics.empty()) return wanted;
  if (topics.size() > 1) {
    throw StartupError(
        file + ": " + std::to_string(topics.size()) + " topics of type " + type + ": " + names_of(topics),
        "choose one with " + option);
  }
  return topics.begin()->first;
}

/// Between the robot and the scans' frame; the remark's words for where it comes from as well.
std::pair<LaserMount, std::string> mount_of(const std::string& file, const BagContents& found, const std::string& base,
                                            const std::string& frame, const BagOptions& options) {
  if (options.robot_from_laser) return {{*options.robot_from_laser}, "as given"};
  const auto joined = found.frames.find(base, frame);
  if (!joined) return {{options.otherwise}, "no transform from " + shown(base) + " to " + shown(frame) + " says it"};
  const auto level = level_mount(*joined);
  if (!level) {
    throw StartupError(file + ": the laser of frame " + shown(frame) + " does not look about level",
                       "give scans of a plane, or the mount with --laser-mount X,Y,YAW");
  }
  return {*level, "from " + shown(base) + " to " + shown(frame) + (level->upside_down ? ", upside down" : "")};
}

void add_scans(sim::RecordedLog& log, const std::string& name, const std::vector<ScanMessage>& scans,
               bool upside_down) {
  sim::LogPlace place{name, 0, "message"};
  for (const ScanMessage& message : scans) {
    ++place.number;
    const std::size_t every = (message.range_m.size() + kMaxBeams - 1) / kMaxBeams;
    std::vector<double> ranges;
    for (std::size_t k = 0; k < message.range_m.size(); k += every) ranges.push_back(message.range_m[k]);
    const float sense = upside_down ? -1.0F : 1.0F;
    const sim::RecordedScan scan{.stamp = message.stamp,
                                 .beams = static_cast<std::uint32_t>(ranges.size()),
                                 .first_angle_rad = sense * message.first_angle_rad,
                                 .angle_step_rad = sense * message.angle_step_rad * static_cast<float>(every),
                                 .range_min_m = message.range_min_m,
                                 .range_max_m = message.range_max_m};
    check_scan(place, scan);
    drop_leapt_scan(log, place, scan.stamp);
    (void)add_scan(log, place, scan, ranges, sim::kNoLimit);
  }
}

void add_odometry(sim::RecordedLog& log, const std::string& name, const std::vector<OdometryMessage>& odometry) {
  sim::LogPlace place{name, 0, "message"};
  sim::OdometryPoses poses(log);
  for (const OdometryMessage& message : odometry) {
    ++place.number;
    poses.add({message.stamp, sim::sound_pose(place, message.pose), message.twist}, place);
  }
}

/// The frame that the odometry moves, or what robots without one call theirs.
std::string base_of(const BagContents& found, const std::string& odom_topic) {
  if (!odom_topic.empty()) {
    const auto& messages = found.odometry.at(odom_topic);
    if (!messages.empty() && !messages.front().child_frame.empty()) return messages.front().child_frame;
  }
  return found.frames.has("base_footprint") && !found.frames.has("base_link") ? "base_footprint" : "base_link";
}

}  // namespace

sim::RecordedLog load_bag(const std::filesystem::path& path, const BagOptions& options) {
  const std::string file = path.string();
  BagContents found;
  read_bag(path, Collector(file, found));
  const std::string scan_topic = choose(file, found.scans, options.scan_topic, "--scan-topic", kScans);
  const std::string odom_topic = choose(file, found.odometry, options.odom_topic, "--odom-topic", kOdometry);
  if (scan_topic.empty()) {
    throw StartupError(file + ": no topic of type " + kScans + " in it; there are: " + listed(found.others),
                       "record the laser's scans");
  }
  const std::vector<ScanMessage>& scans = found.scans.at(scan_topic);
  const auto [mount, source] = mount_of(file, found, base_of(found, odom_topic), scans.front().frame, options);
  sim::RecordedLog log;
  log.robot_from_laser = mount.robot_from_laser;
  add_scans(log, file + ": " + scan_topic, scans, mount.upside_down);
  require_scans(log, file + ": " + scan_topic, "a laser");
  if (!odom_topic.empty()) {
    add_odometry(log, file + ": " + odom_topic, found.odometry.at(odom_topic));
    compare_times(log, file + ": " + odom_topic);
  }
  const double sweep_s =
      static_cast<double>(scans.front().beam_step_s) * static_cast<double>(scans.front().range_m.size() - 1);
  log.sweep = sweep_s > 0.0 && sweep_s < 1.0 ? duration_from_seconds(sweep_s) : log.spinning_sweep();
  char at[96];
  const Pose2& p = mount.robot_from_laser;
  std::snprintf(at, sizeof at, "laser at %.3f,%.3f,%.4f (", p.x, p.y, p.heading);
  log.remark += (log.remark.empty() ? "" : "\n") + file + ": scans of " + shown(scan_topic) +
                (odom_topic.empty() ? ", no odometry" : ", odometry of " + shown(odom_topic)) + ", " + at + source +
                ")";
  return log;
}

}  // namespace jaywalk::exchange
