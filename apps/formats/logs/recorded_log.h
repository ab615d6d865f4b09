#pragma once
// A recording of laser and odometry in memory, and the text formats that it is read from.
// Wheel encoders are computed from recorded poses, as they would have led there.
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hal/types/geometry.h"
#include "hal/types/robot_model.h"
#include "hal/types/time.h"
#include "hal/types/wheels.h"

namespace jaywalk::sim {

/// A pose as a recording gives it, in the recording's own frame.
struct OdometryPose {
  Time stamp = kNever;
  Pose2 pose;
  std::optional<Twist2> twist = std::nullopt;  ///< where the recording says it
  std::size_t number = 0;                      ///< of its line or message, while it is read
};

/// The drive that replayed wheel angles belong to: any would do, as integrating the angles uses the same numbers.
[[nodiscard]] DriveModel nominal_drive();

/// Wheel readings that a differential drive integrating exact arcs turns back into the poses. Angles begin at zero with
/// the first pose.
///
/// Between two poses the drive runs along a circle's arc through the heading's change da: its length is
/// s = c (da/2) / sin(da/2) with c the displacement along the mean heading. A displacement across it (side slip, a SLAM
/// correction) stays as an error of position until the robot has turned. Poses more than 0.15 s apart that no arc joins
/// to 1 cm: the drive turns, drives straight and turns, in thirds of the time, with a reading after each, unless up to
/// 3 cm aside would take a turn of over 15 degrees: scans between would be seen that far turned. Heading is exact at
/// every pose. Speeds are the recording's where it has them, else differences. `poses` has rising stamps.
[[nodiscard]] std::vector<WheelState> wheel_trail(const std::vector<OdometryPose>& poses, const DriveModel& drive);

/// The same with readings every 0.1 s at least, the wheels turning evenly, where two are up to 1.5 s apart.
[[nodiscard]] std::vector<WheelState> filled_in(const std::vector<WheelState>& trail);

/// Times of a trail's reports: the median period, and the 95th percentile of lateness beyond it. At least a loop's
/// period, at most what a base may have (report_ms, report_late_ms); longer silence is a gap.
[[nodiscard]] DriveTimes report_times(const std::vector<WheelState>& trail);

/// One sweep; its ranges are `RecordedLog::range_m[first_range]` and on.
struct RecordedScan {
  Time stamp = kNever;
  std::size_t number = 0;  ///< of its line or message
  std::size_t first_range = 0;
  std::uint32_t beams = 0;
  float first_angle_rad = 0.0F;
  float angle_step_rad = 0.0F;
  float range_min_m = 0.0F;
  float range_max_m = 0.0F;
};

/// Where in a recording something stands: a line of a text file, a message of a bag.
struct LogPlace {
  std::string file;        ///< "scan.txt", "drive.mcap: /scan"
  std::size_t number = 0;  ///< from 1
  std::string unit = "line";

  /// Throws StartupError "scan.txt:17: cause; remedy" or "drive.mcap: /scan: message 17: cause; remedy".
  [[noreturn]] void refuse(const std::string& cause, const std::string& remedy) const;
};

/// Lines of one file, or messages of one topic, that were left out for one reason.
struct RefusedLines {
  LogPlace place;  ///< of the first
  std::string cause;
  std::size_t count = 0;
};

/// Stamps are seconds since the recording's own epoch; both lists rise strictly.
struct RecordedLog {
  Pose2 robot_from_laser;
  Duration sweep{0};  ///< of each scan, from the first beam to the last; 0: not known
  std::vector<RecordedScan> scans;
  std::vector<float> range_m;          ///< of all scans, one after the other
  std::vector<OdometryPose> odometry;  ///< empty where the recording has none
  std::vector<RefusedLines> refused;   ///< what was left out; empty for a clean recording
  std::vector<Time> own_stamps;        ///< of the scans, as recorded, where theirs are even instead; or empty
  std::size_t far_ranges = 0;          ///< over 100 m, and another than the last one over 100 m
  std::string remark;                  ///< what else a person should know, a line each; or empty

  /// Counts what is left out; the first of its kind is remembered.
  void refuse(const LogPlace& place, std::string_view cause);
  void add_remark(const std::string& line) { remark += (remark.empty() ? "" : "\n") + line; }
  /// "scan.txt: 3 lines left out, the first is line 17: its time does not grow"; a line a reason, and the remark.
  [[nodiscard]] std::string complaint() const;
  /// The recording's own time at `stamp`: `stamp` itself where its times could be taken as they are.
  [[nodiscard]] Time own_time(Time stamp) const;
  /// The laser as the first scan shows it, at the median rate. Noise and drop-out are unknown: zero.
  [[nodiscard]] LaserModel laser() const;
  /// How long a sweep takes when the laser spins once a scan, and no slower than ten times a second: logs are thinned
  /// out, and spinning lasers slower than that are rare.
  [[nodiscard]] Duration spinning_sweep() const;
};

/// Reads `scan_file`: a scan a line, told apart by the place of the number of beams n, which must
/// agree with the length of the line:
///   t angle_min angle_inc range_min range_max n r1..rn
///   t dx dy dphi aperture max_range n r1..rn       (own odometry: the motion since the line before, in its frame then)
/// and `odom_file`, where given: t x y yaw v w. Metres, radians, seconds; .gz as it is. In the second form the beams
/// spread over the aperture as CARMEN's do (load_carmen), the motion of a line that is left out still counts, and even
/// times take the place of times that cannot be the laser's. Lasers of the first form are taken to spin
/// (spinning_sweep): a robot that turns sees the whole room bent otherwise. The others turn too fast to matter.
///
/// Leaves out and counts lines of a wrong length, lines with values that are no scan, pose or speed, and lines with
/// wrong stamps (judge_times). Scans of changing numbers of beams get one (fit_beams). Odometry that jumps farther than
/// a robot drives begins anew where the robot is. Throws StartupError "FILE:LINE: cause; remedy" for odometry none of
/// which is of the scans' time (compare_times), for anything else that is wrong, and when no scan is left.
[[nodiscard]] RecordedLog load_scan_odom(const std::filesystem::path& scan_file,
                                         const std::optional<std::filesystem::path>& odom_file = std::nullopt,
                                         const Pose2& robot_from_laser = {});

/// Reads a CARMEN log, .gz as it is: ODOM lines and those of its laser, ROBOTLASER1, FLASER or RAWLASER1, the first of
/// these that it has. The newer two say where their beams are, and ROBOTLASER1 where the laser is: that counts where
/// `robot_from_laser` is zero.
///
/// FLASER's scanner looks ahead over 180 degrees; beam 0 points to -90 degrees. An even number n of beams is 180/n
/// degrees apart, an odd one 180/(n - 1): 180 and 181 beams both at one degree. Readings of 50 m and over are the
/// scanners' codes for "nothing" and become infinite. Odometry is the robot's pose in the laser's lines, and the ODOM
/// lines between them. Where a log's poses were corrected afterwards its ODOM lines repeat, go back in time or jump:
/// those that do not come after what is known are left out and counted, a laser's line overrules what it contradicts,
/// and all are left out where more than one scan in ten lies a centimetre beside them. Errors as load_scan_odom.
[[nodiscard]] RecordedLog load_carmen(const std::filesystem::path& file, const Pose2& robot_from_laser = {});

/// The directions of a scan's beams.
struct BeamAngles {
  double first_rad = 0.0, step_rad = 0.0;
  std::size_t beams = 0;

  [[nodiscard]] double angle_rad(std::size_t beam) const { return first_rad + step_rad * static_cast<double>(beam); }
  /// The beam nearest to that direction; -1 outside the fan.
  [[nodiscard]] std::ptrdiff_t beam_at(double angle) const;
};

/// `beams` readings over an aperture centred ahead, as CARMEN counts them.
[[nodiscard]] BeamAngles carmen_fan(std::size_t beams, double aperture_rad);

/// Fills `out`, a range a beam of `to`, from `ranges`, one a beam of `from`. Where several fall on one, the nearest hit
/// counts; where none does, the one beside it within the scan's own step, else nothing is known (NaN).
void resample(const BeamAngles& from, std::span<const float> ranges, const BeamAngles& to, std::span<float> out);

/// Gives every scan the number of beams of the median scan, in its directions, and remarks on it: drivers of spinning
/// lasers publish a different number each turn.
void fit_beams(RecordedLog& log, const std::string& name);

}  // namespace jaywalk::sim
