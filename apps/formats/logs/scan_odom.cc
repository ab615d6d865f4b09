#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

#include "apps/formats/logs/log_checks.h"
#include "apps/formats/logs/recorded_log.h"
#include "hal/types/errors.h"

namespace jaywalk::sim {
namespace {

/// Words before the ranges in the two forms; the last of them is the number of beams.
constexpr std::size_t kPlainHead = 6, kMotionHead = 7;

/// True when the last word of the head is how many words follow it. That can be so in one place only: it tells the two
/// forms apart.
bool counts_beams(const LineFile& file, std::size_t head) {
  if (file.words().size() <= head) return false;
  return file.words()[head - 1] == std::to_string(file.words().size() - head);
}

/// Length of the line's head; 0 where it is of neither form.
std::size_t head_of(const LineFile& file) {
  if (counts_beams(file, kPlainHead)) return kPlainHead;
  return counts_beams(file, kMotionHead) ? kMotionHead : 0;
}

void read_plain(RecordedLog& log, const LineFile& file) {
  RecordedScan scan;
  scan.stamp = time_from_seconds(file.seconds(0));
  scan.first_angle_rad = static_cast<float>(file.number(1));
  scan.angle_step_rad = static_cast<float>(file.number(2));
  scan.range_min_m = static_cast<float>(file.number(3));
  scan.range_max_m = static_cast<float>(file.number(4));
  scan.beams = static_cast<std::uint32_t>(file.words().size() - kPlainHead);
  add_scan(log, file, scan, kPlainHead, kNoLimit);
}

/// Lines that tell how the robot moved since the line before.
///
/// Some recordings were stamped by a program that went through them later: a dozen scans share a stamp while the robot
/// drives two metres, and times between them tell how long that program took. Where that is so in five lines, and one
/// of a hundred, no time in the file is of use: the lines are taken as evenly spaced from the first stamp to the last.
class MotionLines {
 public:
  explicit MotionLines(RecordedLog& log) : log_(log) {}

  void read(const LineFile& file) {
    const Time said = time_from_seconds(file.seconds(0));
    const Pose2 moved = lines_ == 0 ? Pose2{} : file.pose(1);  // the first's led to where this begins
    const std::optional<Pose2> led_to = sound_pose(odometry_ * moved);
    if (!led_to) return log_.refuse(file.place(), kNoPose);
    odometry_ = *led_to;
    see(said, moved);
    if (!add_scan(log_, file, scan_of(file, said), kMotionHead, file.number(5))) return;
    log_.odometry.push_back({said, odometry_});
    numbers_.push_back(lines_ - 1);
  }
  /// Replaces stamps that cannot be the laser's; own_stamps keeps them.
  void even_out(const std::string& file) {
    if (stood_ < kFewest || stood_ * kOneLineIn <= lines_) return;
    for (std::size_t k = 0; k < log_.scans.size(); ++k) {
      log_.own_stamps.push_back(log_.scans[k].stamp);
      log_.scans[k].stamp = log_.odometry[k].stamp = even(numbers_[k]);
    }
    log_.add_remark(file + ": the robot drives in " + std::to_string(stood_) +
                    " lines though their time stands still: these are not the laser's times; its scans are taken to be "
                    "evenly spaced over the whole");
  }
  [[nodiscard]] bool any() const { return lines_ > 0; }

 private:
  static constexpr std::size_t kFewest = 5, kOneLineIn = 100;
  static constexpr double kDrivesM = 0.02, kDrivesRad = 0.02;  // more than a standing robot's wheels make up
  // No laser turns faster than the one; recorded ones turn ten times a second more often than not.
  static constexpr Duration kShortestStep = std::chrono::milliseconds(1), kOtherwise = std::chrono::milliseconds(100);

  void see(Time said, const Pose2& moved) noexcept {
    const bool drives = norm(moved.position()) > kDrivesM || std::fabs(moved.heading) > kDrivesRad;
    if (lines_++ == 0)
      first_ = last_ = said;
    else if (said <= last_ && drives)
      ++stood_;
    last_ = std::max(last_, said);
  }
  /// Evenly spaced time of line `k`, from the first stamp to the last; at 10 Hz where both are the same.
  [[nodiscard]] Time even(std::size_t k) const {
    const auto steps = static_cast<Duration::rep>(std::max<std::size_t>(lines_, 2) - 1);
    const auto at = static_cast<Duration::rep>(k);
    const Duration step = (last_ - first_) / steps;
    return first_ + (step >= kShortestStep ? step : kOtherwise) * at;
  }
  static RecordedScan scan_of(const LineFile& file, Time stamp) {
    RecordedScan scan;
    scan.stamp = stamp;
    scan.beams = static_cast<std::uint32_t>(file.words().size() - kMotionHead);
    const BeamAngles fan = carmen_fan(scan.beams, file.number(4));
    scan.first_angle_rad = static_cast<float>(fan.first_rad);
    scan.angle_step_rad = static_cast<float>(fan.step_rad);
    scan.range_max_m = static_cast<float>(file.number(5));
    return scan;
  }

  RecordedLog& log_;
  Pose2 odometry_;
  std::size_t lines_ = 0, stood_ = 0;  ///< stood: the robot drove though time stood still
  std::vector<std::size_t> numbers_;   ///< of the scans' lines
  Time first_ = kNever, last_ = kNever;
};

/// True when the scans carried their own odometry.
bool read_scans(RecordedLog& log, const std::filesystem::path& path) {
  LineFile file(path);
  MotionLines motion(log);
  std::size_t head = 0;
  while (file.next()) {
    if (head == 0) head = head_of(file);
    if (head == 0 || !counts_beams(file, head))
      log.refuse(file.place(), kWrongLength);
    else if (head == kPlainHead)
      read_plain(log, file);
    else
      motion.read(file);
  }
  motion.even_out(file.name());
  const std::vector<bool> stays = settle_times(log, file.place());
  keep(log.odometry, stays);
  keep(log.own_stamps, stays);
  require_scans(log, file.name(), "lines 't angle_min angle_inc range_min range_max n r1..rn'");
  return motion.any();
}

/// Words of a line of odometry that are time, x, y, heading and, where there are speeds, v and w.
using OdometryColumns = std::vector<std::size_t>;

struct KnownNames {
  const char* of;
  std::array<std::string_view, 5> names;
};
constexpr std::array<KnownNames, 4> kColumnNames{
    {{"time", {"t_s", "t", "time", "timestamp", "stamp"}},
     {"position", {"est_x_m", "x_m", "x", "px", "pos_x"}},
     {"position", {"est_y_m", "y_m", "y", "py", "pos_y"}},
     {"heading", {"est_heading_rad", "heading_rad", "theta", "yaw", "heading"}}}};

/// Columns by their names in the first line. The estimate counts in a robot.csv, which has the world's truth beside it.
OdometryColumns named_columns(RecordedLog& log, const LineFile& file) {
  OdometryColumns columns;
  std::string told;
  for (const auto& [of, names] : kColumnNames) {
    const auto* const name = std::ranges::find_first_of(names, file.words());
    if (name == names.end()) file.refuse("no column for the " + std::string(of) + " in it", "name columns t,x,y,theta");
    columns.push_back(static_cast<std::size_t>(std::ranges::find(file.words(), *name) - file.words().begin()));
    told += (told.empty() ? "" : ", ") + std::string(*name);
  }
  log.add_remark(file.name() + ": of its columns " + told + " are taken");
  return columns;
}

/// Without names: t x y yaw, and v w where the lines have six words.
OdometryColumns counted_columns(RecordedLog& log, const LineFile& file) {
  if (file.has_commas()) log.add_remark(file.name() + ": its columns are taken as time, x, y, heading");
  return file.words().size() == 6 ? OdometryColumns{0, 1, 2, 3, 4, 5} : OdometryColumns{0, 1, 2, 3};
}

/// True where the first line names columns: one is a time, or a CSV file's line begins with a letter.
bool names_columns(const LineFile& file) {
  const std::string_view first = file.words().front();
  const auto& times = kColumnNames[0].names;
  return std::ranges::find_first_of(times, file.words()) != times.end() ||
         (file.has_commas() && !first.empty() && std::isalpha(static_cast<unsigned char>(first.front())) != 0);
}

void read_odometry(RecordedLog& log, const std::filesystem::path& path) {
  LineFile file(path);
  LogOdometry odometry(log);
  OdometryColumns columns;
  std::size_t words = 0;
  while (file.next()) {
    if (columns.empty()) {
      words = file.words().size();
      if (names_columns(file)) {
        columns = named_columns(log, file);
        continue;
      }
      if (words == 4 || words == 6) columns = counted_columns(log, file);
    }
    if (columns.empty() || file.words().size() != words) {
      log.refuse(file.place(), kWrongLength);
      continue;
    }
    const auto number = [&](std::size_t k) { return file.number(columns[k]); };
    std::optional<Twist2> twist;
    if (columns.size() == 6) twist = Twist2{number(4), number(5)};
    odometry.add({time_from_seconds(file.seconds(columns[0])), {number(1), number(2), number(3)}, twist}, file.place());
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
