#include <algorithm>
#include <cmath>
#include <utility>

#include "apps/formats/logs/recorded_log.h"
#include "apps/formats/logs/scan_lines.h"
#include "hal/types/trig.h"

namespace jaywalk::sim {
namespace {

constexpr double kApertureRad = kPi;
constexpr double kNothingFromM = 50.0;  ///< SICK's codes are 81.83 and 81.91, others write 50
constexpr float kRangeMinM = 0.02F;

// FLASER n r1..rn x y theta odom_x odom_y odom_theta t host t
constexpr std::size_t kLaserRanges = 2, kLaserTail = 9, kOdomPoseInTail = 3, kTimeInTail = 6;
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

/// The robot's poses as the FLASER lines have them, and how many lie beside the ODOM lines' way.
struct LaserPoses {
  std::vector<OdometryPose> poses;
  std::size_t beside = 0;

  void add(const std::vector<OdometryPose>& odometry, const OdometryPose& pose) {
    if (!odometry.empty() && sideways(inverse(odometry.back().pose) * pose.pose) > kSidewaysM) ++beside;
    poses.push_back(pose);
  }
  [[nodiscard]] bool were_corrected() const {
    return poses.size() >= kEnoughScans && beside * kCorrectedOneIn > poses.size();
  }
};

void read_laser(RecordedLog& log, LaserPoses& poses, const LineFile& file) {
  const std::size_t words = file.words().size();
  const std::size_t beams = words > 1 ? file.count(1, 1'000'000) : 0;
  if (words != kLaserRanges + beams + kLaserTail) {
    log.refuse(file.place(), kWrongLength);
    return;
  }
  if (beams == 0 || beams > kMaxBeams) {
    file.refuse(std::to_string(beams) + " beams", "give scans of 1 to " + std::to_string(kMaxBeams) + " beams");
  }
  const std::size_t tail = kLaserRanges + beams;
  const BeamFan fan = carmen_fan(beams, kApertureRad);
  RecordedScan scan;
  scan.stamp = time_from_seconds(file.seconds(tail + kTimeInTail));
  scan.beams = static_cast<std::uint32_t>(beams);
  scan.first_angle_rad = fan.first_angle_rad;
  scan.angle_step_rad = fan.angle_step_rad;
  scan.range_min_m = kRangeMinM;
  scan.range_max_m = static_cast<float>(kNothingFromM);
  if (!add_scan(log, file, scan, kLaserRanges, kNothingFromM)) return;
  while (!log.odometry.empty() && log.odometry.back().stamp >= scan.stamp) log.odometry.pop_back();
  const OdometryPose pose{scan.stamp, pose_at(file, tail + kOdomPoseInTail), std::nullopt};
  poses.add(log.odometry, pose);
  log.odometry.push_back(pose);
}

void read_odometry(RecordedLog& log, const LineFile& file) {
  if (file.words().size() != kOdomWords) {
    log.refuse(file.place(), kWrongLength);
    return;
  }
  const Time stamp = time_from_seconds(file.seconds(kOdomTime));
  if (!log.odometry.empty() && stamp <= log.odometry.back().stamp) {
    log.refuse(file.place(), kOdomStands);
    return;
  }
  log.odometry.push_back({stamp, pose_at(file, 1), std::nullopt});
}

/// Those whose time does not grow are no matter then.
void leave_out_odometry(RecordedLog& log, LaserPoses& poses, const std::string& file) {
  log.odometry = std::move(poses.poses);
  std::erase_if(log.refused, [](const RefusedLines& r) { return r.cause == kOdomStands; });
  log.remark =
      file + ": its scans' poses lie beside its ODOM lines, as if corrected afterwards: all ODOM lines are left out";
}

}  // namespace

RecordedLog load_carmen(const std::filesystem::path& path, const Pose2& robot_from_laser) {
  RecordedLog log;
  log.robot_from_laser = robot_from_laser;
  LineFile file(path);
  LaserPoses poses;
  while (file.next()) {
    if (file.words().front() == "FLASER") read_laser(log, poses, file);
    if (file.words().front() == "ODOM") read_odometry(log, file);
  }
  require_scans(log, file.name(), "CARMEN messages, FLASER among them");
  if (poses.were_corrected()) leave_out_odometry(log, poses, file.name());
  return log;
}

}  // namespace jaywalk::sim
