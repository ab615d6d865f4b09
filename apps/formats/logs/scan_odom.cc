#include <algorithm>
#include <array>
#include <cctype>

#include "apps/formats/logs/log_checks.h"
#include "apps/formats/logs/recorded_log.h"
#include "hal/types/errors.h"

namespace jaywalk::sim {
namespace {

/// Words before the ranges in the two forms; the last of them is the number of beams.
constexpr std::size_t kPlainHead = 6, kMotionHead = 7;

enum class Form { kNone, kPlain, kMotion };

/// True when the last word of the head is how many words follow it. That can be so in one place only: it tells the two
/// forms apart.
bool counts_beams(const LineFile& file, std::size_t head) {
  if (file.words().size() <= head) return false;
  return file.words()[head - 1] == std::to_string(file.words().size() - head);
}

Form form_of(const LineFile& file) {
  if (counts_beams(file, kPlainHead)) return Form::kPlain;
  return counts_beams(file, kMotionHead) ? Form::kMotion : Form::kNone;
}

void read_plain(LogScans& scans, const LineFile& file) {
  RecordedScan scan;
  scan.stamp = time_from_seconds(file.seconds(0));
  scan.first_angle_rad = static_cast<float>(file.number(1));
  scan.angle_step_rad = static_cast<float>(file.number(2));
  scan.range_min_m = static_cast<float>(file.number(3));
  scan.range_max_m = static_cast<float>(file.number(4));
  scan.beams = static_cast<std::uint32_t>(file.words().size() - kPlainHead);
  add_scan(scans, file, scan, kPlainHead, kNoLimit);
}

/// Reads the lines that tell how the robot moved since the line before.
class MotionLines {
 public:
  /// By the lines' own times, or evenly where `wrong` is given: what a reading by their own times has found.
  explicit MotionLines(RecordedLog& log, const LineClock* wrong = nullptr) : log_(log), wrong_(wrong) {}

  void read(LogScans& scans, const LineFile& file) {
    const Time said = time_from_seconds(file.seconds(0));
    const Pose2 moved = lines_ == 0 ? Pose2{} : pose_at(file, 1);  // the first's led to where this begins
    const std::optional<Pose2> led_to = sound_pose(odometry_ * moved);
    if (!led_to) return log_.refuse(file.place(), kNoPose);
    odometry_ = *led_to;
    RecordedScan scan = scan_of(file);
    scan.stamp = wrong_ == nullptr ? said : wrong_->even(lines_);
    clock_.see(said, moved);
    ++lines_;
    if (!add_scan(scans, file, scan, kMotionHead, file.number(5))) return;
    log_.odometry.push_back({scan.stamp, odometry_, std::nullopt});
    if (wrong_ != nullptr) log_.own_stamps.push_back(said);
  }
  /// What goes with the scans that stay.
  void keep_those(const std::vector<bool>& stays) {
    if (!any()) return;
    keep(log_.odometry, stays);
    if (wrong_ != nullptr) keep(log_.own_stamps, stays);
  }

  [[nodiscard]] const LineClock& clock() const { return clock_; }
  [[nodiscard]] bool any() const { return lines_ > 0; }

 private:
  static RecordedScan scan_of(const LineFile& file) {
    RecordedScan scan;
    scan.beams = static_cast<std::uint32_t>(file.words().size() - kMotionHead);
    const BeamFan fan = carmen_fan(scan.beams, file.number(4));
    scan.first_angle_rad = fan.first_angle_rad;
    scan.angle_step_rad = fan.angle_step_rad;
    scan.range_max_m = static_cast<float>(file.number(5));
    return scan;
  }

  RecordedLog& log_;
  const LineClock* wrong_;
  LineClock clock_;
  Pose2 odometry_;
  std::size_t lines_ = 0;
};

/// True when the scans carried their own odometry.
bool read_scans(RecordedLog& log, const std::filesystem::path& path, MotionLines& motion) {
  LineFile file(path);
  LogScans scans(log);
  Form form = Form::kNone;
  while (file.next()) {
    if (form == Form::kNone) form = form_of(file);
    if (form == Form::kNone || !counts_beams(file, form == Form::kPlain ? kPlainHead : kMotionHead))
      log.refuse(file.place(), kWrongLength);
    else if (form == Form::kPlain)
      read_plain(scans, file);
    else
      motion.read(scans, file);
  }
  motion.keep_those(scans.settle_times(file.place()));
  require_scans(log, file.name(), "lines 't angle_min angle_inc range_min range_max n r1..rn'");
  return motion.any();
}

/// The scans of `path` by their own times, or evenly where those cannot be the laser's.
bool read_scans(RecordedLog& log, const std::filesystem::path& path) {
  MotionLines motion(log);
  if (!read_scans(log, path, motion)) return false;
  if (!motion.clock().wrong()) return true;
  const LineClock wrong = motion.clock();
  const Pose2 mount = log.robot_from_laser;
  log = RecordedLog();
  log.robot_from_laser = mount;
  MotionLines evenly(log, &wrong);
  (void)read_scans(log, path, evenly);
  log.add_remark(path.string() + ": the robot drives in " + std::to_string(wrong.stood()) +
                 " lines though their time stands still: these are not the laser's times; its scans are taken to be "
                 "evenly spaced over the whole");
  return true;
}

/// Which words of a line of odometry are time, x, y, heading, v and w.
struct OdometryColumns {
  std::vector<std::size_t> at{0, 1, 2, 3};  ///< four of them where it has no speeds
};

constexpr std::array<std::array<std::string_view, 5>, 4> kColumnNames{
    {{"t_s", "t", "time", "timestamp", "stamp"},
     {"est_x_m", "x_m", "x", "px", "pos_x"},
     {"est_y_m", "y_m", "y", "py", "pos_y"},
     {"est_heading_rad", "heading_rad", "theta", "yaw", "heading"}}};

/// Columns by their names in the first line. The estimate counts in a robot.csv, which has the world's truth beside it.
OdometryColumns named_columns(RecordedLog& log, const LineFile& file) {
  OdometryColumns columns;
  std::string told;
  for (std::size_t k = 0; k < kColumnNames.size(); ++k) {
    const auto* const name = std::ranges::find_if(kColumnNames[k], [&](std::string_view one) {
      return std::ranges::find(file.words(), one) != file.words().end();
    });
    if (name == kColumnNames[k].end())
      file.refuse("no column for the " +
                      std::string(k == 0   ? "time"
                                  : k == 3 ? "heading"
                                           : "position") +
                      " in it",
                  "name columns t,x,y,theta");
    columns.at[k] = static_cast<std::size_t>(std::ranges::find(file.words(), *name) - file.words().begin());
    told += (told.empty() ? "" : ", ") + std::string(*name);
  }
  log.add_remark(file.name() + ": of its columns " + told + " are taken");
  return columns;
}

/// Without names: t x y yaw, and v w where the lines have six words.
OdometryColumns counted_columns(RecordedLog& log, const LineFile& file) {
  OdometryColumns columns;
  if (file.words().size() == 6) columns.at = {0, 1, 2, 3, 4, 5};
  if (file.has_commas()) log.add_remark(file.name() + ": its columns are taken as time, x, y, heading");
  return columns;
}

/// True where the first line names columns: one is a time, or a CSV file's line begins with a letter.
bool names_columns(const LineFile& file) {
  const auto is_time = [](std::string_view word) {
    return std::ranges::find(kColumnNames[0], word) != kColumnNames[0].end();
  };
  const std::string_view first = file.words().front();
  return std::ranges::any_of(file.words(), is_time) ||
         (file.has_commas() && !first.empty() && std::isalpha(static_cast<unsigned char>(first.front())) != 0);
}

void read_odometry(RecordedLog& log, const std::filesystem::path& path) {
  LineFile file(path);
  LogOdometry odometry(log);
  std::optional<OdometryColumns> columns;
  std::size_t words = 0;
  while (file.next()) {
    if (!columns) {
      const bool is_named = names_columns(file);
      words = file.words().size();
      if (!is_named && words != 4 && words != 6) {
        log.refuse(file.place(), kWrongLength);
        continue;
      }
      columns = is_named ? named_columns(log, file) : counted_columns(log, file);
      if (is_named) continue;
    }
    if (file.words().size() != words) {
      log.refuse(file.place(), kWrongLength);
      continue;
    }
    const auto number = [&](std::size_t k) { return file.number(columns->at[k]); };
    std::optional<Twist2> twist;
    if (columns->at.size() == 6) twist = Twist2{number(4), number(5)};
    odometry.add({time_from_seconds(file.seconds(columns->at[0])), {number(1), number(2), number(3)}, twist},
                 file.place());
  }
  odometry.settle(file.place());
  if (log.odometry.empty()) throw StartupError(file.name() + ": no odometry in it", "give lines 't x y yaw v w'");
}

}  // namespace

RecordedLog load_scan_odom(const std::filesystem::path& scan_file,
                           const std::optional<std::filesystem::path>& odom_file, const Pose2& robot_from_laser) {
  RecordedLog log;
  log.robot_from_laser = robot_from_laser;
  const bool own_odometry = read_scans(log, scan_file);
  if (own_odometry && odom_file) {
    throw StartupError(odom_file->string() + ": " + scan_file.string() + " carries its own odometry",
                       "give the scans alone");
  }
  if (odom_file) {
    read_odometry(log, *odom_file);
    compare_times(log, odom_file->string());
  }
  fit_beams(log, scan_file.string());
  remark_gaps(log, scan_file.string());
  if (!own_odometry) log.sweep = log.spinning_sweep();
  return log;
}

}  // namespace jaywalk::sim
