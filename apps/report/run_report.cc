#include "apps/report/run_report.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>
#include <system_error>

#include "firmware/control_loop.h"
#include "hal/text_file.h"
#include "hal/types/errors.h"

namespace jaywalk {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

using Json = nlohmann::ordered_json;

std::unique_ptr<RunTables> open_tables(const std::filesystem::path& folder, const std::filesystem::path& tables) {
  if (folder.empty()) return nullptr;
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  for (const char* last_written : {"summary.json", "run.png", "run.svg", "run.mcap"}) {
    if (!error) std::filesystem::remove(folder / last_written, error);
  }
  if (error) throw StartupError(folder.string() + ": " + error.message(), "choose another --out folder");
  return std::make_unique<RunTables>(tables);
}

/// NaN and infinity, which JSON has no word for, become null.
Json spread(const Distribution& of) {
  return {{"p50", of.quantile(0.5)}, {"p99", of.quantile(0.99)}, {"max", of.max()}};
}

/// Bins are doublings: upper edge and count.
Json spread(const LogHistogram& of) {
  return {{"p50", of.quantile(0.5)},
          {"p99", of.quantile(0.99)},
          {"p99.9", of.quantile(0.999)},
          {"max", of.max()},
          {"bins", of.doublings()}};
}

template <class T>
Json known(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

/// When each began, and how long it took.
void add_times(Json& j, const std::string& of, const std::vector<Episode>& episodes) {
  Json at = Json::array(), lasted = Json::array();
  for (const Episode& episode : episodes) at.push_back(episode.from_s), lasted.push_back(episode.to_s - episode.from_s);
  j[of + "_at_s"] = at, j[of + "_for_s"] = lasted;
}

/// At full speed; infinite where no way is known.
double way_to_go_m(const ControlLoop& loop, Vec2 here) {
  const Guide& guide = loop.plan().guide;
  const float to_go_s =
      guide.known() ? guide.time_to_go(static_cast<float>(here.x), static_cast<float>(here.y)) : Guide::kNoWay_s;
  return to_go_s < Guide::kNoWay_s ? static_cast<double>(to_go_s) * loop.setup().model.limits.max_speed_mps
                                   : std::numeric_limits<double>::infinity();
}

/// Holds 64 KiB in the run's folder, so that a disk that other files have filled meanwhile still takes its summary.
/// Throws StartupError where the disk has no room for it. A file system that cannot hold room is passed over.
std::shared_ptr<void> reserve_in(const std::filesystem::path& folder) {
  constexpr off_t kBytes = 64 * 1024;  // a summary.json and a devices.json have 2 to 5 kB
  const std::filesystem::path file = folder / ".reserve";
  std::shared_ptr<void> held(nullptr, [file](void*) {
    std::error_code gone;
    std::filesystem::remove(file, gone);
  });
  const int descriptor = ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  const int error = descriptor < 0 ? errno : ::posix_fallocate(descriptor, 0, kBytes);
  if (descriptor >= 0) ::close(descriptor);
  if (error != ENOSPC && error != EDQUOT) return held;
  throw StartupError(folder.string() + ": " + std::strerror(error), "free some space, or choose another --out folder");
}

}  // namespace

RunTables::RunTables(const std::filesystem::path& folder)
    : robot_((folder / "robot.csv").string(),
             "t_s,x_m,y_m,heading_rad,v_mps,w_radps,est_x_m,est_y_m,est_heading_rad,wanted_v_mps,permitted_v_mps,"
             "left_radps,right_radps,reasons"),
      movers_((folder / "movers.csv").string(), "t_s,id,x_m,y_m,vx_mps,vy_mps,forced"),
      tracks_((folder / "tracks.csv").string(), "t_s,id,x_m,y_m,vx_mps,vy_mps,moving,std_m,radius_m,pedestrian") {}

void RunTables::add(const RunSample& sample) {
  add_robot(sample);
  if (sample.truth != nullptr) add_movers(sample);
  if (sample.record.scan_count() != scan_count_) add_tracks(sample);
  scan_count_ = sample.record.scan_count();
  if (age(written_at_, sample.record.now) < kLongestWait) return;
  for (CsvFile* const table : {&robot_, &movers_, &tracks_}) table->write_out();
  written_at_ = sample.record.now;
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
  const TrueState unknown{{kUnknown, kUnknown, kUnknown}, {kUnknown, kUnknown}, {}};
  const TrueState& truth = sample.truth != nullptr ? *sample.truth : unknown;
  robot_.seconds(sample.now).pose(truth.map_from_robot).number(truth.twist.v_mps).number(truth.twist.w_radps);
  robot_.pose(r.pose.map_from_robot).number(r.wanted.v_mps).number(r.verdict.permitted.v_mps);
  robot_.number(r.command.left_radps).number(r.command.right_radps);
  robot_.text(to_string(r.verdict.reasons, r.verdict.faulty_scanners)).end_row();
}

void RunTables::add_movers(const RunSample& sample) {
  for (const TrueMover& mover : sample.truth->movers) {
    movers_.seconds(sample.now).count(mover.id).vector(mover.position_in_map).vector(mover.velocity_in_map);
    movers_.count(mover.forced ? 1 : 0).end_row();
  }
}

void RunTables::add_tracks(const RunSample& sample) {
  for (const Track& track : sample.tracks) {
    tracks_.seconds(sample.scanned).count(track.id).vector(track.position_in_map).vector(track.velocity_in_map);
    tracks_.count(track.moving ? 1 : 0).number(std::sqrt(track.covariance.pp)).number(track.radius_m);
    tracks_.count(track.is_pedestrian ? 1 : 0).end_row();
  }
}

RunReport::RunReport(const std::filesystem::path& folder, const std::filesystem::path& tables)
    : folder_(folder), tables_(open_tables(folder, tables)) {
  if (tables_) reserve_ = reserve_in(folder_);
}

void RunReport::continue_in(const std::filesystem::path& tables, Time last) {
  if (next_tables_) turn_to_next_tables();  // their first tick was not kept
  next_tables_ = std::make_unique<RunTables>(tables);
  last_of_tables_ = last;
}

void RunReport::turn_to_next_tables() {
  tables_->close();
  lost_ = complaints();
  next_tables_->follow(*tables_);
  tables_ = std::move(next_tables_);
}

void RunReport::add(const RunSample& sample) {
  const Time now = sample.record.now;
  if (next_tables_ && now > last_of_tables_) turn_to_next_tables();
  if (tables_) tables_->add(sample);
  if (ticks_++ == 0) first_ = now;
  last_ = now;
  tick_ms_.add(to_seconds(sample.tick_took) * 1e3);
  if (sample.plan_took) {
    plan_ms_.add(sample.plan_took->ms);
    plan_processor_ms_.add(sample.plan_took->processor_ms);
    plan_device_ms_.add(sample.plan_took->device_ms);
  }
  const Pose2& pose = sample.truth ? sample.truth->map_from_robot : sample.record.pose.map_from_robot;
  add_way(pose, sample);
  if (sample.truth != nullptr) add_truth(*sample.truth, now);
  granted_.add(sample.record);
  add_faults(sample.record.verdict.reasons);
  add_tracks(sample);
}

void RunReport::add_faults(Reason reasons) {
  constexpr Reason kStoppedBy = of_kind(ReasonKind::kFault) | kAlwaysLatched;
  const bool is_faulty = has(reasons, kStoppedBy) && !has(reasons, Reason::kEmergencyStop);
  if (is_faulty && !is_faulty_) ++faults_;
  is_faulty_ = is_faulty;
}

void RunReport::add_way(const Pose2& pose, const RunSample& sample) {
  shape_.add(pose.position());
  driven_.add(sample.record.now, pose, sample.record.scan);
  if (!sample.record.input.has_goal) return;
  const double t_s = to_seconds(sample.now);
  const Vec2 goal = sample.record.input.goal_in_map;
  loops_.add(t_s, pose, goal);
  if (sample.loop == nullptr) return;
  if (!detours_) detours_.emplace();
  detours_->add(t_s, pose.position(), goal, way_to_go_m(*sample.loop, sample.record.pose.map_from_robot.position()));
}

void RunReport::add_truth(const TrueState& truth, Time now) {
  smoothness_.add(now, truth.twist.v_mps);
  const TrueState before = truth_.value_or(TrueState{});
  truth_ = truth;
  truth_->movers = {};
  truth_->clearance_m = std::min(before.clearance_m, truth.clearance_m);
  truth_->mover_clearance_m = std::min(before.mover_clearance_m, truth.mover_clearance_m);
  for (const TrueMover& mover : truth.movers) {
    movers_.add(mover.id, now, mover.position_in_map, mover.radius_m, mover.forced);
  }
}

void RunReport::add_tracks(const RunSample& sample) {
  for (const Track& track : sample.tracks) {
    if (track.last_seen == track.stamp) {  // where it was seen, not where it may have gone
      tracks_.add(track.id, track.stamp, track.position_in_map, track.radius_m, track.moving);
    }
  }
}

std::vector<std::string> RunReport::complaints() const {
  std::vector<std::string> all = lost_;
  if (tables_) std::ranges::copy(tables_->complaints(), std::back_inserter(all));
  return all;
}

std::string RunReport::finish(const RunEnd& end) {
  if (tables_) tables_->close();
  reserve_.reset();
  std::string text = summary(end);
  if (!folder_.empty()) write_text(folder_ / "summary.json", text, "free some disk");
  return text;
}

std::string RunReport::summary(const RunEnd& end) const {
  const TrueState truth = truth_.value_or(TrueState{});
  const auto of_truth = [&](const auto& value) { return truth_ ? Json(value) : Json(nullptr); };
  const auto named = [](const std::string& name) { return name.empty() ? Json(nullptr) : Json(name); };
  Json j;
  j["outcome"] = end.outcome;
  j["success"] = of_truth(end.success);
  j["path_length_m"] = shape_.length_m();
  j["static_shortest_path_m"] = known(end.static_shortest_path_m);
  j["heading_error_rad"] = known(end.heading_error_rad);
  j["found_mount_yaw_rad"] = known(end.found_mount_yaw_rad);
  j["found_clock_offset_s"] = known(end.found_clock_offset_s);
  j["duration_s"] = duration_s();
  j["min_clearance_m"] = of_truth(truth.clearance_m);
  j["min_mover_clearance_m"] = of_truth(truth.mover_clearance_m);
  j["forced_movers"] = of_truth(truth.forced_movers);
  j["contacts"] = of_truth(truth.contacts);
  j["contacts_caused"] = of_truth(truth.contacts_caused);
  j["intimate_s"] = of_truth(truth.social.intimate_s);
  j["personal_s"] = of_truth(truth.social.personal_s);
  j["slowed_m"] = of_truth(truth.social.slowed_m);
  j["turned_rad"] = of_truth(truth.social.turned_rad);
  j["max_turn_deg"] = shape_.max_turn_deg();
  j["turn_histogram"] = shape_.turn_histogram();
  j["turn_bin_deg"] = kTurnBinDeg;
  j["loops"] = loops_.loops().size();
  add_times(j, "loops", loops_.loops());
  j["detour_m"] = detours_ ? Json(detours_->detour_m()) : Json(nullptr);
  add_times(j, "detours", detours_ ? detours_->detours() : std::vector<Episode>{});
  j["accel_max_mps2"] = smoothness_.accel_max_mps2();
  j["jerk_p99_mps3"] = smoothness_.jerk_quantile_mps3(0.99);
  j["jerk_max_mps3"] = smoothness_.jerk_quantile_mps3(1.0);
  j["granted_share"] = granted_.mean();
  j["steered_s"] = granted_.steered_s();
  j["ticks"] = ticks_;
  j["faults"] = faults_;
  j["missed_ticks"] = end.missed_ticks;
  j["dropped_records"] = end.dropped_records;
  j["not_recorded"] = complaints();
  for (const std::string& complaint : end.not_recorded) j["not_recorded"].push_back(complaint);
  j["plan_ms"] = spread(plan_ms_);
  j["plan_processor_ms"] = spread(plan_processor_ms_);
  j["plan_device_ms"] = spread(plan_device_ms_);
  j["tick_ms"] = spread(tick_ms_);
  const LoopTimes* const loop = end.loop_times;
  j["wake_late_us"] = loop != nullptr ? spread(loop->wake_late_us) : Json(nullptr);
  j["tick_us"] = loop != nullptr ? spread(loop->tick_us) : Json(nullptr);
  j["page_faults"] =
      loop != nullptr ? Json{{"minor", loop->minor_faults}, {"major", loop->major_faults}} : Json(nullptr);
  j["backend"] = end.backend;
  j["mode"] = end.mode;
  j["seed"] = known(end.seed);
  j["scenario"] = end.scenario;
  j["settings"] = end.settings;
  j["planner"] = named(end.planner);
  j["mover_rule"] = named(end.mover_rule);
  j["measured_on"] = truth_ ? "truth" : "estimate";
  j["version"] = end.version;
  return j.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace jaywalk
