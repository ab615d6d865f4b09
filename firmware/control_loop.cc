#include "firmware/control_loop.h"

#include <algorithm>
#include <chrono>
#include <cstdio>

#include "hal/types/errors.h"

namespace jaywalk {
namespace {

std::string recording_in(const RunParts& parts) { return (parts.place() / "recording.jwr").string(); }

/// A known map is in the head of every part.
const PartsKept& checked(const PartsKept& kept, const ControlSetup& setup) {
  const std::uintmax_t head = kept.bytes > 0 ? to_text(setup).size() : 0, least = std::max(kLeastPartBytes, 4 * head);
  if (kept.bytes == 0 || kept.bytes >= least) return kept;
  throw StartupError("--part-bytes " + std::to_string(kept.bytes) + ": too small: the head of each part has " +
                         std::to_string(head) + " bytes",
                     "give " + std::to_string(least) + " at least, or 0 for no parts");
}

}  // namespace

ControlLoop::ControlLoop(const ControlSetup& setup, Hal hal, Planner& planner, Recorder& recorder)
    : setup_(setup),
      hal_(hal),
      planner_(planner),
      recorder_(recorder),
      estimator_(setup),
      motion_(setup.make_motion(setup.motion())),
      latency_(setup.model.drive),
      known_walls_(setup.model.footprint),
      supervisor_({.model = setup.model,
                   .tick = setup.tick(),
                   .needs_wheels = setup.wheels,
                   .judges_motion = setup.judges_motion && setup.wheels && setup.applies_verdict(),
                   .latches_all = setup.wired,
                   .proves_wheels = setup.wired && setup.judges_motion && setup.wheels}),
      plan_(&planner.collect()) {
  const std::size_t there = 1 + hal.other_lasers.size(), wanted = setup.model.lasers().size();
  if (there != wanted)
    throw StartupError(
        "the robot has " + std::to_string(wanted) + " scanners, and " + std::to_string(there) + " can be read here",
        "give what was recorded or wired with as many");
  for (std::size_t k = 0; k < wanted; ++k) beam_filters_.emplace_back(setup.model, k, setup.wheels);
}

const TickRecord& ControlLoop::tick(Time now) noexcept {
  TickRecord& t = recorder_.begin(now);        // preallocated; all that crosses the HAL this tick
  read_devices(t);                             // sense: the newest of each; nothing waits
  const bool new_scan = estimator_.update(t);  // estimate, track
  t.pose = estimator_.pose_at(now);
  take_plan(t);  // of an earlier tick's request
  estimator_.forget_where_stuck(t);
  ask(t);     // motion asks,
  permit(t);  // the supervisor permits,
  send(t);    // the wheels have their command
  estimator_.end_tick(t);
  think_on(t, new_scan);
  recorder_.commit();
  return t;
}

void ControlLoop::read_devices(TickRecord& t) noexcept {
  t.wheels = hal_.drive.latest();
  t.scan = hal_.laser.latest();
  beam_filters_[0].filter(t.scan, t.wheels);
  t.other_scans.clear();
  for (std::size_t k = 0; k < hal_.other_lasers.size(); ++k) {
    (void)t.other_scans.push_back(hal_.other_lasers[k]->latest());
    t.other_scans[k].scanner = static_cast<std::uint8_t>(k + 1);
    beam_filters_[k + 1].filter(t.other_scans[k], t.wheels);
  }
  t.input = hal_.panel.latest();
  t.fix = hal_.pose_source.latest();
}

void ControlLoop::take_plan(TickRecord& t) noexcept {
  plan_ = &planner_.collect();
  t.plan_sequence = plan_->sequence;
  t.plan_status = plan_->status;
  if (std::exchange(plan_noted_, plan_->sequence) != plan_->sequence) keep_path(*plan_, t.path);
}

void ControlLoop::ask(TickRecord& t) noexcept {
  zone_speed_ = motion::zone_speed(setup_.zones, setup_.model, t.pose.map_from_robot.position());
  const motion::World world = this->world(t);
  const motion::Intent intent = this->intent(t);
  motion_->observe(world, intent);
  t.wanted = motion_->command(world, intent);
  const motion::MotionStatus status = motion_->status();
  t.plan_stamp = status.rests_on;
  t.wished = is_steered(t) ? status.stick_asks : Twist2{};
}

void ControlLoop::permit(TickRecord& t) noexcept {
  const motion::MotionStatus status = motion_->status();
  t.latency = latency_.measured();
  t.verdict = supervisor_.judge(
      t.wanted,
      {t.scans(), t.wheels, t.input, t.plan_stamp, t.now, t.latency, status.turns_at_goal, zone_speed_.here_mps, sent_,
       known_walls_.near(tracker().still(), t.pose.map_from_robot), &known_walls_, t.pose.doubtful});
  if (status.turn_blocked) t.verdict.reasons |= Reason::kTurnBlocked;
  if (recorder_.is_losing()) t.verdict.reasons |= Reason::kNotRecorded;
  driven_ = setup_.applies_verdict() ? t.verdict.permitted : t.wanted;
}

void ControlLoop::send(TickRecord& t) noexcept {
  t.command = wheel_speeds(setup_.model.drive, driven_, t.now);
  hal_.drive.command(t.command);
  t.took = hal_.clock.now() - t.now;
  latency_.add(t.now, t.took, t.wheels, t.command);
  sent_ = t.command;
}

void ControlLoop::think_on(TickRecord& t, bool new_scan) noexcept {
  motion::World world = this->world(t);
  world.new_scan = new_scan;
  world.new_plan = t.input.has_goal && std::exchange(plan_decided_on_, plan_->sequence) != plan_->sequence;
  if (world.new_scan || world.new_plan) motion_->decide(world, intent(t));
  t.plan_asked = new_scan && t.input.has_goal && !planner_.is_busy() && age(asked_, t.now) >= motion_->plan_every();
  if (t.plan_asked) asked_ = t.now, planner_.submit(motion_->request(world));
}

motion::Intent ControlLoop::intent(const TickRecord& t) const noexcept {
  using Kind = motion::Intent::Kind;
  const bool counts = supervisor_.takes_wishes();
  if (is_steered(t)) return {Kind::kStick, counts ? t.input.stick : Stick{}, zone_speed_.ahead_mps};
  const bool to_goal = t.input.has_goal && (counts || !setup_.applies_verdict());
  return {to_goal ? Kind::kGoal : Kind::kRest, {}, zone_speed_.ahead_mps};
}

motion::World ControlLoop::world(const TickRecord& t) const noexcept {
  const LaserScan& newest = t.newest_scan();
  OfOthers<SeenFrom> others;
  for (const LaserScan& scan : t.scans())
    if (&scan != &newest && scan.sequence != 0) (void)others.push_back({&scan, map_from_laser(scan)});
  return {.now = t.now,
          .map_from_robot = t.pose.map_from_robot,
          .driven = driven_,
          .input = t.input,
          .scan = newest,
          .map_from_laser = map_from_laser(newest),
          .perceived = {.tracks = tracker().tracks(),
                        .moving = tracker().moving(),
                        .standing = tracker().standing(),
                        .still = tracker().still()},
          .plan = *plan_,
          .unseen_walls = supervisor_.unseen_walls(),
          .other_scans = others};
}

Pose2 ControlLoop::map_from_laser(const LaserScan& scan) const noexcept {
  const Pose2& mount = setup_.model.lasers()[scan.scanner].robot_from_laser;
  return estimator_.map_from_robot_at_scan(scan.scanner) * mount;
}

LoopRunner::LoopRunner(const ControlSetup& setup, Hal hal, const Files& files, TickObserver& observer,
                       const MakePlanner& make)
    : setup_(setup),
      clock_(hal.clock),
      out_(files.folder),
      parts_(files.folder, checked(files.parts, setup)),
      chosen_(make ? make(setup) : make_planner(setup)),
      recorder_({.file = files.records ? recording_in(parts_) : "", .setup = to_text(setup)}),
      loop_(setup, hal, *chosen_.planner, recorder_),
      observer_(observer),
      recording_(files.records && !parts_.any() ? files.folder / "recording.jwr" : std::filesystem::path()),
      due_(hal.clock.now()) {
  observer_.begin(files.folder, parts_.place(), setup_);
}

const TickRecord& LoopRunner::step_at(Time due) {
  clock_.sleep_until(due);
  tick_at(due);
  drain();
  return *record_;
}

/// What is recorded stays within its bounds, whatever happens: without a next part it ends.
void LoopRunner::begin_part() noexcept try {
  parts_.next();
  ControlSetup setup = setup_;
  setup.part = parts_.number();
  recorder_.continue_in(recording_in(parts_), to_text(setup));
  observer_.continue_in(parts_.place(), recorder_.last_drained());
} catch (const StartupError& error) {
  recorder_.end_recording();
  observer_.end_tables();
  const std::string said = error.what();
  tell_loss(said.substr(0, said.rfind("; ")));  // the remedy is not the one for a start
}

void LoopRunner::drain() {
  if (losses_.empty() && parts_.is_full(recorder_.bytes() + observer_.bytes())) begin_part();
  if (!recorder_.drain()) tell_losses();
}

void LoopRunner::report(const RunSample& sample) {
  observer_.report(sample);
  if (observer_.is_losing()) tell_losses();
}

void LoopRunner::tell_losses() {
  std::vector<std::string> complaints = observer_.complaints();
  if (std::string complaint = recorder_.complaint(); !complaint.empty()) complaints.push_back(std::move(complaint));
  for (const std::string& complaint : complaints)
    if (std::find(losses_.begin(), losses_.end(), complaint) == losses_.end()) tell_loss(complaint);
}

void LoopRunner::tell_loss(const std::string& complaint) {
  losses_.push_back(complaint);
  recorder_.note_loss();
  std::fprintf(stderr, "jaywalk: %s; free some space; what stands in it is whole up to now\n", complaint.c_str());
}

const TickRecord& LoopRunner::tick_at(Time due) noexcept {
  const auto began = std::chrono::steady_clock::now();
  record_ = &loop_.tick(due);
  took_ = std::chrono::steady_clock::now() - began;
  if (took_ > setup_.tick()) ++overruns_;
  due_ = due + setup_.tick();
  return *record_;
}

void LoopRunner::report(const TrueState* truth, const OwnTime& own) {
  RunSample sample{.record = *record_,
                   .tracks = loop_.tracker().tracks(),
                   .truth = truth,
                   .tick_took = took_,
                   .loop = &loop_,
                   .planner = chosen_.planner.get()};
  if (loop_.plan().sequence != plan_reported_) sample.plan_took = loop_.plan().took;
  plan_reported_ = loop_.plan().sequence;
  if (own) sample.now = own(sample.now), sample.scanned = own(sample.scanned);
  report(sample);
}

std::filesystem::path LoopRunner::finish(RunEnd end) {
  recorder_.close();
  tell_losses();
  const std::vector<std::string> tables = observer_.complaints();
  for (const std::string& loss : losses_)
    if (std::find(tables.begin(), tables.end(), loss) == tables.end()) end.not_recorded.push_back(loss);
  end.dropped_records = recorder_.dropped();
  end.backend = chosen_.planner->backend();
  if (!chosen_.why_not_cuda.empty()) end.backend += " (" + chosen_.why_not_cuda + ")";
  end.mode = name_of(setup_.mode);
  end.version = JAYWALK_VERSION;
  end.recording = recording_;
  if (end.title.empty()) end.title = end.scenario;
  const std::filesystem::path shown = observer_.finish(end, loop_, *chosen_.planner);
  tell_losses();
  return shown.empty() ? out_.path() : shown;
}

void LoopRunner::require_recorded() const {
  if (losses_.empty()) return;
  throw StartupError(losses_.front(), "free some space and run again; what stands in it is whole up to there");
}

}  // namespace jaywalk
