#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "apps/formats/bag_file.h"
#include "apps/formats/logs/log_checks.h"
#include "apps/formats/ros_input.h"
#include "hal/shown_text.h"
#include "hal/types/errors.h"

namespace jaywalk::exchange {
namespace {

constexpr const char* kScans = "sensor_msgs/LaserScan";
constexpr const char* kOdometry = "nav_msgs/Odometry";
constexpr double kLongestSweepS = 1.0;
constexpr double kSamePeriod = 1.05;  // stamps and drivers' figures are that exact

/// All that a replay could need of a recording, by topic.
struct BagContents {
  std::string file;
  std::map<std::string, std::vector<ScanMessage>> scans = {};
  std::map<std::string, std::vector<OdometryMessage>> odometry = {};
  sim::RecordedLog unreadable = {};  ///< counts what was left out
  FrameTree frames = {};
  std::map<std::string, std::string> others = {};    ///< topics of other types, with those
  std::map<std::string, std::size_t> messages = {};  ///< how many were read or left out of each topic

  void add(const BagMessage& message) {
    const std::string topic(message.topic);
    const std::string_view type = message.type, bytes = message.bytes;
    const Wire wire = message.wire;
    const bool ros = wire == Wire::kCdr || wire == Wire::kRos1, foxglove = wire == Wire::kProtobuf;
    if (ros && type == kScans)
      take(read_scan(bytes, wire), scans[topic], message);
    else if (foxglove && type == "foxglove.LaserScan")
      take(read_foxglove_scan(bytes), scans[topic], message);
    else if (ros && type == kOdometry)
      take(read_odometry(bytes, wire), odometry[topic], message);
    else if (ros && (type == "tf2_msgs/TFMessage" || type == "tf/tfMessage"))
      take(read_transforms(bytes, wire), message);
    else if (foxglove && type == "foxglove.FrameTransform")
      take(read_foxglove_transform(bytes), message);
    else if (foxglove && type == "foxglove.FrameTransforms")
      take(read_foxglove_transforms(bytes), message);
    else
      others.emplace(topic, type);
  }

  /// Number of the message on its topic; counts it as left out where it could not be read.
  std::size_t numbered(const BagMessage& message, bool is_read) {
    const std::size_t number = ++messages[std::string(message.topic)];
    if (!is_read)
      unreadable.refuse({file + ": " + shown(message.topic), number, "message"},
                        "its bytes are no " + shown(message.type));
    return number;
  }
  void take(const std::optional<std::vector<TransformMessage>>& read, const BagMessage& message) {
    (void)numbered(message, read.has_value());
    if (!read) return;
    for (const TransformMessage& transform : *read) frames.add(transform);
  }
  template <class Read>
  void take(std::optional<Read> read, std::vector<Read>& list, const BagMessage& message) {
    const std::size_t number = numbered(message, read.has_value());
    if (!read) return;
    if (read->stamp == Time{}) read->stamp = message.logged;
    read->number = number;
    read->logged = message.logged;
    list.push_back(std::move(*read));
  }
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

/// The frames that may be the robot's: what the odometry moves first, then what robots call theirs.
std::vector<std::string> bases_of(const BagContents& found, const std::string& odom_topic) {
  std::vector<std::string> bases;
  if (!odom_topic.empty()) {
    for (const OdometryMessage& message : found.odometry.at(odom_topic))
      if (!message.child_frame.empty() && bases.empty()) bases.push_back(message.child_frame);
  }
  for (const char* usual : {"base_link", "base_footprint"})
    if (bases.empty() || FrameTree::bare(bases.front()) != usual) bases.emplace_back(usual);
  return bases;
}

/// The first that is named; an odd first message may name none.
std::string frame_of(const std::vector<ScanMessage>& scans) {
  const auto named =
      std::find_if(scans.begin(), scans.end(), [](const ScanMessage& scan) { return !scan.frame.empty(); });
  return named == scans.end() ? "" : named->frame;
}

/// Between the robot and the scans' frame; the remark's words for where it comes from as well.
std::pair<LaserMount, std::string> mount_of(const std::string& file, const BagContents& found,
                                            const std::vector<std::string>& bases, const std::string& frame,
                                            const BagOptions& options) {
  if (options.robot_from_laser) return {{*options.robot_from_laser}, "as given"};
  for (const std::string& base : bases) {
    const auto joined = found.frames.find(base, frame);
    if (!joined) continue;
    const auto level = level_mount(*joined);
    if (!level) {
      throw StartupError(file + ": the laser of frame " + shown(frame) + " does not look about level",
                         "give scans of a plane, or the mount with --laser-mount X,Y,YAW");
    }
    return {*level, "from " + shown(base) + " to " + shown(frame) + (level->upside_down ? ", upside down" : "")};
  }
  return {{options.otherwise}, "no transform from " + shown(bases.front()) + " to " + shown(frame) + " says it"};
}

/// The farthest hit of all: for messages that say no limit.
float farthest_of(const std::vector<ScanMessage>& messages) {
  float farthest = 1.0F;
  for (const ScanMessage& message : messages) {
    for (const float range : message.range_m)
      if (std::isfinite(range)) farthest = std::max(farthest, range);
  }
  return farthest;
}

void add_scans(sim::RecordedLog& log, const std::string& name, const std::vector<ScanMessage>& messages,
               bool upside_down) {
  sim::LogPlace place{name, 0, "message"};
  const float farthest_m = farthest_of(messages);
  for (const ScanMessage& message : messages) {
    place.number = message.number;
    const std::size_t every = std::max<std::size_t>((message.range_m.size() + kMaxBeams - 1) / kMaxBeams, 1);
    std::vector<double> ranges;
    for (std::size_t k = 0; k < message.range_m.size(); k += every) ranges.push_back(message.range_m[k]);
    const float sense = upside_down ? -1.0F : 1.0F;
    sim::add_scan(log, place,
                  {.stamp = message.stamp,
                   .beams = static_cast<std::uint32_t>(ranges.size()),
                   .first_angle_rad = sense * message.first_angle_rad,
                   .angle_step_rad = sense * message.angle_step_rad * static_cast<float>(every),
                   .range_min_m = message.range_min_m,
                   .range_max_m = std::isinf(message.range_max_m) ? farthest_m : message.range_max_m},
                  ranges, sim::kNoLimit);
  }
  (void)sim::settle_times(log, place);
}

/// True where most messages have an orientation; the others are left out.
bool has_orientation(const std::vector<OdometryMessage>& messages) {
  const auto without =
      std::ranges::count_if(messages, [](const OdometryMessage& said) { return std::isnan(said.pose.heading); });
  return 2 * without <= static_cast<std::ptrdiff_t>(messages.size());
}

/// Median time from a message's stamp until it was recorded; there is one message at least.
template <class Message>
Duration usual_delay(const std::vector<Message>& messages) {
  std::vector<Duration> delays;
  for (const Message& message : messages) delays.push_back(message.logged - message.stamp);
  const auto middle = delays.begin() + static_cast<std::ptrdiff_t>(delays.size() / 2);
  std::ranges::nth_element(delays, middle);
  return *middle;
}

/// Moves the odometry's stamps by what its clock is behind that of the scans, by when both were recorded. Less than the
/// way of the messages may take is no lag: a scan is recorded a sweep after its stamp, or at once.
void use_times_of_recording(sim::RecordedLog& log, const std::string& name, const std::vector<ScanMessage>& scans,
                            std::vector<OdometryMessage>& odometry) {
  constexpr Duration kWay = std::chrono::milliseconds(50);
  if (odometry.empty()) return;
  const Duration lag = usual_delay(odometry) - usual_delay(scans);
  const double rate_hz = log.laser().rate_hz;
  const Duration sweep = duration_from_seconds(rate_hz > 0.0 ? 1.0 / rate_hz : 0.0);
  if (lag <= kWay && lag >= -kWay - sweep) return;
  for (OdometryMessage& message : odometry) message.stamp += lag;
  log.add_remark(name + formatted(": its clock is %.3f s behind", to_seconds(lag)) +
                 " that of the scans, by the times of recording, which count");
}

void add_odometry(sim::RecordedLog& log, const std::string& name, const std::vector<OdometryMessage>& messages) {
  sim::LogPlace place{name, 0, "message"};
  sim::LogOdometry odometry(log);
  for (const OdometryMessage& message : messages) {
    place.number = message.number;
    odometry.add({message.stamp, message.pose, message.twist}, place);
  }
  odometry.settle(place);
}

/// How long a sweep takes by its messages, unless that is longer than from one scan to the next: then the laser is
/// taken to spin.
Duration sweep_of(sim::RecordedLog& log, const std::string& name, const std::vector<ScanMessage>& messages) {
  std::vector<double> sweeps_s;
  for (const ScanMessage& message : messages)
    if (message.range_m.size() > 1)
      sweeps_s.push_back(static_cast<double>(message.beam_step_s) * static_cast<double>(message.range_m.size() - 1));
  std::sort(sweeps_s.begin(), sweeps_s.end(),
            [](double a, double b) { return a < b || (std::isnan(b) && !std::isnan(a)); });
  const double sweep_s = sweeps_s.empty() ? 0.0 : sweeps_s[sweeps_s.size() / 2];
  const double rate_hz = log.laser().rate_hz, period_s = rate_hz > 0.0 ? 1.0 / rate_hz : kLongestSweepS;
  if (!(sweep_s > 0.0)) return log.spinning_sweep();
  if (sweep_s <= kSamePeriod * period_s && sweep_s < kLongestSweepS) return duration_from_seconds(sweep_s);
  const Duration taken = log.spinning_sweep();
  const std::string told =
      formatted(": time_increment says sweeps of %.3f s, scans come every %.3f s: taken to sweep in %.3f s", sweep_s,
                period_s, to_seconds(taken));
  log.add_remark(name + told);
  return taken;
}

}  // namespace

sim::RecordedLog load_bag(const std::filesystem::path& path, const BagOptions& options) {
  const std::string file = path.string();
  BagContents found{.file = file};
  const std::string left_out = read_bag(path, [&found](const BagMessage& message) { found.add(message); });
  const std::string scan_topic = choose(file, found.scans, options.scan_topic, "--scan-topic", kScans);
  const std::string odom_topic = choose(file, found.odometry, options.odom_topic, "--odom-topic", kOdometry);
  if (scan_topic.empty()) {
    throw StartupError(file + ": no topic of type " + kScans + " in it; there are: " + listed(found.others),
                       "record the laser's scans");
  }
  const std::vector<ScanMessage>& scans = found.scans.at(scan_topic);
  sim::RecordedLog log = std::move(found.unreadable);
  if (!left_out.empty()) log.add_remark(left_out.substr(0, left_out.size() - 1));
  const std::string scan_name = file + ": " + shown(scan_topic), odom_name = file + ": " + shown(odom_topic);
  if (scans.empty()) sim::require_scans(log, scan_name, "a laser");
  const auto [mount, source] = mount_of(file, found, bases_of(found, odom_topic), frame_of(scans), options);
  log.robot_from_laser = mount.robot_from_laser * scans.front().frame_from_scan;
  add_scans(log, scan_name, scans, mount.upside_down);
  require_scans(log, scan_name, "a laser");
  sim::fit_beams(log, scan_name);
  if (!odom_topic.empty() && has_orientation(found.odometry.at(odom_topic))) {
    std::vector<OdometryMessage>& odometry = found.odometry.at(odom_topic);
    use_times_of_recording(log, odom_name, scans, odometry);
    add_odometry(log, odom_name, odometry);
    if (!log.odometry.empty()) compare_times(log, odom_name);
  } else if (!odom_topic.empty()) {
    log.add_remark(odom_name + ": left out: its orientations are no quaternions (0 0 0 0, or an angle in their place)");
  }
  log.sweep = sweep_of(log, scan_name, scans);
  sim::remark_gaps(log, scan_name);
  const Pose2& p = log.robot_from_laser;
  const std::string at = formatted("laser at %.3f,%.3f,%.4f (", p.x, p.y, p.heading);
  log.add_remark(file + ": scans of " + shown(scan_topic) +
                 (log.odometry.empty() ? ", no odometry" : ", odometry of " + shown(odom_topic)) + ", " + at + source +
                 ")");
  return log;
}

}  // namespace jaywalk::exchange
