#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "apps/formats/logs/log_checks.h"
#include "apps/formats/logs/recorded_log.h"
#include "hal/shown_text.h"
#include "hal/types/trig.h"

namespace jaywalk::sim {
namespace {

constexpr double kApertureRad = kPi;
constexpr double kNothingFromM = 50.0;  ///< SICK's codes are 81.83 and 81.91, others write 50
constexpr float kRangeMinM = 0.02F;

// ODOM x y theta tv rv accel t host t
constexpr std::size_t kOdomWords = 10, kOdomTime = 7;

constexpr const char* kOdomStands =
    "an ODOM line whose time does not grow, as logs have that were corrected afterwards";

// Where a log was corrected afterwards, a scan's pose lies beside where the ODOM lines led: by more than a wheeled
// robot can have gone sideways, and not just once.
constexpr double kSidewaysM = 0.01;
constexpr std::size_t kCorrectedOneIn = 10, kEnoughScans = 20;

/// How far a step leads across its mean heading: along it lies what a circle's arc can do.
double sideways(const Pose2& step) {
  return std::fabs(cos(0.5 * step.heading) * step.y - sin(0.5 * step.heading) * step.x);
}

/// Where a laser message has what. FLASER's beams are CARMEN's old ones over half a turn, the newer messages say
/// theirs.
struct LaserMessage {
  const char* name;
  std::size_t count;  ///< the word that says how many ranges follow it
  std::size_t pose;   ///< the robot's, by its odometry, in words behind ranges and remissions; 0: it has none
  std::size_t time;   ///< in words behind those
  std::size_t tail;   ///< how many words are behind those
  bool tells_beams;   ///< kind, first angle, field of view, step, longest range, accuracy, remission mode come first
};
// FLASER n r.. x y theta odom_x odom_y odom_theta t host t
// ROBOTLASER1 (7 words) n r.. m remissions.. laser_pose(3) robot_pose(3) tv rv (3 distances) t host t
// RAWLASER1 (7 words) n r.. m remissions.. t host t
constexpr std::array<LaserMessage, 3> kLasers{
    {{"ROBOTLASER1", 8, 3, 11, 14, true}, {"FLASER", 1, 3, 6, 9, false}, {"RAWLASER1", 8, 0, 0, 3, true}}};
constexpr double kSameMountM = 0.02, kSameMountRad = 0.01;
constexpr std::size_t kLaserPose = 0;  // of ROBOTLASER1, likewise: in the frame of the robot's

/// The messages of one log. The laser's are those of one kind: logs have the same scans in several.
class CarmenReader {
 public:
  CarmenReader(RecordedLog& log, const LaserMessage& laser) : log_(log), laser_(laser) {}

  void read(const LineFile& file) {
    if (file.words().front() == laser_.name) read_laser(file);
    if (file.words().front() == "ODOM") read_odometry(file);
  }
  /// Odometry, and what corrections left of it, of the scans that stay.
  void settle(const LogPlace& place) {
    const std::vector<bool> stays = settle_times(log_, place);
    if (log_.scans.empty()) return;
    if (mount_ && mount_is_fixed_ && log_.robot_from_laser == Pose2{}) use_mount(place.file);
    std::size_t scan = 0;
    for (const auto& [pose, of_scan] : events_)
      if (!of_scan)
        append_between(pose, {place.file, pose.number});
      else if (stays[scan++] && laser_.pose > 0)
        append_scan(pose);
    if (poses_.size() >= kEnoughScans && beside_ * kCorrectedOneIn > poses_.size()) leave_out_odometry(place.file);
  }

 private:
  void read_laser(const LineFile& file) {
    const std::size_t words = file.words().size(), first = laser_.count + 1;
    const std::size_t beams = words > laser_.count ? file.count(laser_.count, 1'000'000) : 0;
    std::size_t tail = first + beams;
    if (laser_.tells_beams && words > tail) tail += 1 + file.count(tail, 1'000'000);  // remissions behind their number
    if (words != tail + laser_.tail) return log_.refuse(file.place(), kWrongLength);
    const RecordedScan scan = scan_of(file, beams, tail);
    const bool tells_limit = laser_.tells_beams && scan.range_max_m < kNothingFromM;
    const double nothing_from_m = tells_limit ? static_cast<double>(scan.range_max_m) : kNothingFromM;
    std::optional<Pose2> pose = Pose2{};
    if (laser_.pose > 0) pose = sound_pose(file.pose(tail + laser_.pose));
    if (!pose) return log_.refuse(file.place(), kNoPose);
    if (!add_scan(log_, file, scan, first, nothing_from_m)) return;
    if (laser_.tells_beams && laser_.pose > 0) see_mount(inverse(*pose) * file.pose(tail + kLaserPose));
    events_.push_back({{scan.stamp, *pose, std::nullopt, file.line()}, true});
  }
  void see_mount(const Pose2& mount) {
    if (!mount_) mount_ = mount;
    const Pose2 apart = inverse(*mount_) * mount;
    mount_is_fixed_ =
        mount_is_fixed_ && norm(apart.position()) < kSameMountM && std::fabs(apart.heading) < kSameMountRad;
  }
  void use_mount(const std::string& file) {
    log_.robot_from_laser = *mount_;
    log_.add_remark(file + formatted(": laser at %.3f,%.3f,%.4f, as the log's poses have it", mount_->x, mount_->y,
                                     mount_->heading));
  }
  RecordedScan scan_of(const LineFile& file, std::size_t beams, std::size_t tail) const {
    const BeamAngles fan = carmen_fan(beams, kApertureRad);
    RecordedScan scan;
    scan.stamp = time_from_seconds(file.seconds(tail + laser_.time));
    scan.beams = static_cast<std::uint32_t>(beams);
    scan.range_min_m = kRangeMinM;
    scan.first_angle_rad = static_cast<float>(laser_.tells_beams ? file.number(2) : fan.first_rad);
    scan.angle_step_rad = static_cast<float>(laser_.tells_beams ? file.number(4) : fan.step_rad);
    scan.range_max_m = static_cast<float>(laser_.tells_beams ? file.number(5) : kNothingFromM);
    return scan;
  }
  void read_odometry(const LineFile& file) {
    if (file.words().size() != kOdomWords) return log_.refuse(file.place(), kWrongLength);
    const std::optional<Pose2> pose = sound_pose(file.pose(1));
    if (!pose) return log_.refuse(file.place(), kNoPose);
    events_.push_back({{time_from_seconds(file.seconds(kOdomTime)), *pose, std::nullopt, file.line()}, false});
  }
  void append_scan(const OdometryPose& pose) {
    while (!log_.odometry.empty() && log_.odometry.back().stamp >= pose.stamp) log_.odometry.pop_back();
    if (!log_.odometry.empty() && sideways(inverse(log_.odometry.back().pose) * pose.pose) > kSidewaysM) ++beside_;
    poses_.push_back(pose);
    log_.odometry.push_back(pose);
  }
  void append_between(const OdometryPose& pose, const LogPlace& place) {
    const Time stamp = pose.stamp;
    if (stamp + kOtherClockFrom < log_.scans.front().stamp || stamp - kOtherClockFrom > log_.scans.back().stamp)
      return log_.refuse(place, kOtherClock);
    if (!log_.odometry.empty() && stamp <= log_.odometry.back().stamp) return log_.refuse(place, kOdomStands);
    log_.odometry.push_back(pose);
  }
  /// Uses the scans' own poses as odometry in place of all ODOM lines, and takes back their refusals for wrong times.
  void leave_out_odometry(const std::string& file) {
    log_.odometry = std::move(poses_);
    std::erase_if(log_.refused, [](const RefusedLines& r) { return r.cause == kOdomStands; });
    log_.add_remark(
        file + ": its scans' poses lie beside its ODOM lines, as if corrected afterwards: all ODOM lines are left out");
  }

  RecordedLog& log_;
  const LaserMessage& laser_;
  std::vector<OdometryPose> poses_;                    ///< as the laser's lines have them
  std::size_t beside_ = 0;                             ///< of them, beside where the ODOM lines led
  std::vector<std::pair<OdometryPose, bool>> events_;  ///< poses, and whether each is a scan's or between scans
  std::optional<Pose2> mount_;                         ///< of the laser, by the poses of both
  bool mount_is_fixed_ = true;                         ///< not so where one of them was corrected afterwards
};

/// The kind of laser message in the log that tells most; FLASER where there is none.
const LaserMessage& laser_of(const std::filesystem::path& path) {
  std::size_t found = kLasers.size();
  LineFile file(path);
  while (found > 0 && file.next())
    for (std::size_t k = 0; k < found; ++k)
      if (file.words().front() == kLasers[k].name) found = k;
  return kLasers[found == kLasers.size() ? 1 : found];
}

}  // namespace

RecordedLog load_carmen(const std::filesystem::path& path, const Pose2& robot_from_laser) {
  RecordedLog log;
  log.robot_from_laser = robot_from_laser;
  CarmenReader reader(log, laser_of(path));
  LineFile file(path);
  while (file.next()) reader.read(file);
  reader.settle(file.place());
  require_scans(log, file.name(), "CARMEN messages, FLASER, ROBOTLASER1 or RAWLASER1 among them");
  fit_beams(log, file.name());
  remark_gaps(log, file.name());
  return log;
}

}  // namespace jaywalk::sim
