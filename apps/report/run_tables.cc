#include "apps/report/run_tables.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <limits>

#include "hal/types/errors.h"

namespace jaywalk {
namespace {
constexpr off_t kBytes = 64 * 1024;  // a summary.json and a devices.json have 2 to 5 kB

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

void add_pose(CsvFile& table, const Pose2& pose) { table.number(pose.x).number(pose.y).number(pose.heading); }
void add_vector(CsvFile& table, Vec2 v) { table.number(v.x).number(v.y); }

}  // namespace

DiskReserve::DiskReserve(const std::filesystem::path& folder) : file_(folder / ".reserve") {
  const int descriptor = ::open(file_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  const int error = descriptor < 0 ? errno : ::posix_fallocate(descriptor, 0, kBytes);
  if (descriptor >= 0) ::close(descriptor);
  if (error != ENOSPC && error != EDQUOT) return;
  release();
  throw StartupError(folder.string() + ": " + std::strerror(error), "free some space, or choose another --out folder");
}

void DiskReserve::release() noexcept {
  std::error_code gone;
  std::filesystem::remove(file_, gone);
}

RunTables::RunTables(const std::filesystem::path& folder)
    : robot_((folder / "robot.csv").string(),
             "t_s,x_m,y_m,heading_rad,v_mps,w_radps,est_x_m,est_y_m,est_heading_rad,wanted_v_mps,permitted_v_mps,"
             "left_radps,right_radps,reasons"),
      movers_((folder / "movers.csv").string(), "t_s,id,x_m,y_m,vx_mps,vy_mps,forced"),
      tracks_((folder / "tracks.csv").string(), "t_s,id,x_m,y_m,vx_mps,vy_mps,moving,std_m") {}

void RunTables::add(const RunSample& sample) {
  add_robot(sample);
  if (sample.truth != nullptr) add_movers(sample);
  if (sample.record.scan_count() != scan_count_) add_tracks(sample);
  scan_count_ = sample.record.scan_count();
  if (age(written_at_, sample.record.now) < kLongestWait) return;
  for (CsvFile* const table : {&robot_, &movers_, &tracks_}) table->write_out();
  written_at_ = sample.record.now;
}

void RunTables::close() {
  for (CsvFile* const table : {&robot_, &movers_, &tracks_}) table->close();
}

bool RunTables::is_losing() const noexcept {
  return robot_.has_failed() || movers_.has_failed() || tracks_.has_failed();
}

std::vector<std::string> RunTables::complaints() const {
  std::vector<std::string> all;
  for (const CsvFile* const table : {&robot_, &movers_, &tracks_}) {
    if (const std::string complaint = table->complaint(); !complaint.empty()) all.push_back(complaint);
  }
  return all;
}

void RunTables::add_robot(const RunSample& sample) {
  const TickRecord& r = sample.record;
  robot_.seconds(sample.now);
  add_pose(robot_, sample.truth ? sample.truth->map_from_robot : Pose2{kUnknown, kUnknown, kUnknown});
  const Twist2 twist = sample.truth ? sample.truth->twist : Twist2{kUnknown, kUnknown};
  robot_.number(twist.v_mps).number(twist.w_radps);
  add_pose(robot_, r.pose.map_from_robot);
  robot_.number(r.wanted.v_mps).number(r.verdict.permitted.v_mps);
  robot_.number(r.command.left_radps).number(r.command.right_radps);
  robot_.text(to_string(r.verdict.reasons, r.verdict.faulty_scanners)).end_row();
}

void RunTables::add_movers(const RunSample& sample) {
  for (const TrueMover& mover : sample.truth->movers) {
    movers_.seconds(sample.now).count(mover.id);
    add_vector(movers_, mover.position_in_map);
    add_vector(movers_, mover.velocity_in_map);
    movers_.count(mover.forced ? 1 : 0).end_row();
  }
}

void RunTables::add_tracks(const RunSample& sample) {
  for (const Track& track : sample.tracks) {
    tracks_.seconds(sample.scanned).count(track.id);
    add_vector(tracks_, track.position_in_map);
    add_vector(tracks_, track.velocity_in_map);
    tracks_.count(track.moving ? 1 : 0).number(std::sqrt(track.covariance.pp)).end_row();
  }
}

}  // namespace jaywalk
