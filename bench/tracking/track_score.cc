#include "bench/tracking/track_score.h"

#include <algorithm>
#include <cmath>

#include "firmware/control_loop.h"
#include "firmware/recording/recorded_hal.h"
#include "firmware/recording/recorder.h"

namespace jaywalk::bench {
namespace {
/// Asked for plans, it has none.
class NoPlanner final : public Planner {
 public:
  void submit(const PlanRequest&) noexcept override {}
  [[nodiscard]] const Plan& collect() noexcept override { return none_; }
  [[nodiscard]] FieldView view_field() const override { return {}; }
  [[nodiscard]] const char* backend() const noexcept override { return "none"; }

 private:
  Plan none_;
};

constexpr double kAwayS = 1.0;  // whoever is out of view this long comes into view again
constexpr double kRoundOffS = 1e-6;
constexpr double kKeepsMps = 0.02;  // recorded velocities are rounded, and movers turn gently

constexpr double kStepM = 0.05;

/// Metres driven until each pair.
std::vector<double> way_m(const std::vector<PosePair>& drive) {
  std::vector<double> way;
  Vec2 last = drive.empty() ? Vec2{} : drive.front().truth.position();
  double sum = 0.0;
  for (const PosePair& p : drive) {
    const double step = distance(last, p.truth.position());
    if (step >= kStepM) sum += step, last = p.truth.position();
    way.push_back(sum);
  }
  return way;
}

double median(std::vector<double>& values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// The estimate's motion from `a` to `b`, seen from where the true one leads.
Pose2 motion_error(const PosePair& a, const PosePair& b) {
  return inverse(inverse(a.truth) * b.truth) * (inverse(a.estimate) * b.estimate);
}

}  // namespace

void Innovations::add(std::span<const Track> tracks) {
  std::map<std::uint32_t, std::uint32_t> hits;
  for (const Track& track : tracks) {
    hits[track.id] = track.hits;
    const auto before = hits_before_.find(track.id);
    if (!track.moving || before == hits_before_.end() || track.hits == before->second) continue;
    count_ += 1;
    sum_ += track.nis;
    within_ += track.nis <= kWithin95 ? 1U : 0U;
  }
  hits_before_ = std::move(hits);
}

Innovations innovations_of(const std::filesystem::path& recording) {
  RecordingReader reader(recording.string());
  const ControlSetup setup = setup_from_text(reader.setup(), recording.string());
  if (setup.mode == PlanMode::kPaper) return {};
  TickRecord recorded;
  RecordedHal devices(recorded);
  NoPlanner planner;
  Recorder recorder({});
  ControlLoop loop(setup, devices.hal(setup.model.lasers().size()), planner, recorder);
  Innovations innovations;
  std::uint32_t last = 0;
  while (reader.next(recorded)) {
    static_cast<void>(loop.tick(recorded.now));
    recorder.drain();
    if (recorded.scan.sequence != last) innovations.add(loop.tracker().tracks());
    last = recorded.scan.sequence;
  }
  return innovations;
}

void TrackScore::pair_up(std::span<const Target> targets, std::span<const Hypothesis> tracks) {
  std::vector<Pair> near;
  for (std::size_t a = 0; a < targets.size(); ++a) {
    for (std::size_t b = 0; b < tracks.size(); ++b) {
      const double d = distance(targets[a].position_in_map, tracks[b].position_in_map);
      const bool may = !rules_.as_it_is || tracks[b].moving || targets[a].stands();
      if (may && d <= rules_.match_m) near.push_back({a, b, d});
    }
  }
  const auto before = [&](const Pair& p) {
    const auto last = track_of_.find(targets[p.target].id);
    return last != track_of_.end() && last->second == tracks[p.track].id;
  };
  std::stable_sort(near.begin(), near.end(), [&](const Pair& p, const Pair& q) {
    return before(p) != before(q) ? before(p) : p.distance_m < q.distance_m;
  });
  std::vector<bool> target_taken(targets.size()), track_taken(tracks.size());
  pairs_.clear();
  for (const Pair& p : near) {
    if (target_taken[p.target] || track_taken[p.track]) continue;
    target_taken[p.target] = track_taken[p.track] = true;
    pairs_.push_back(p);
  }
}

void TrackScore::count(double t_s, const Target& target, const Hypothesis& track, double distance_m) {
  matches_ += 1;
  distance_sum_m_ += distance_m;
  const auto last = track_of_.find(target.id);
  if (last != track_of_.end() && last->second != track.id) {
    switches_ += 1;
    quick_switches_ += t_s - found_s_[target.id] <= rules_.kept_s + kRoundOffS ? 1U : 0U;
  }
  track_of_[target.id] = track.id;
  found_s_[target.id] = t_s;
  const double off = distance(track.velocity_in_map, target.velocity_in_map);
  if (std::isnan(off) || t_s - born_s_[track.id] < rules_.settled_after_s) return;
  compared_ += 1;
  velocity_error2_sum_ += off * off;
  compare_steady(t_s, target, track, distance_m);
}

void TrackScore::note_steady(double t_s, const Target& target) {
  const auto known = steady_.find(target.id);
  if (known != steady_.end() && distance(known->second.velocity_in_map, target.velocity_in_map) <= kKeepsMps) return;
  steady_[target.id] = {t_s, target.velocity_in_map};  // NaN too: never steady
}

void TrackScore::compare_steady(double t_s, const Target& target, const Hypothesis& track, double distance_m) {
  if (target.stands() || t_s - steady_[target.id].since_s < rules_.settled_after_s) return;
  steady_compared_ += 1;
  steady_wrong_ += distance(track.velocity_in_map, target.velocity_in_map) > rules_.steady_mps ? 1U : 0U;
  if (std::isnan(track.std_m)) return;
  claimed_ += 1;
  covered_ += distance_m * distance_m <= kWithin95 * track.std_m * track.std_m ? 1U : 0U;
}

void TrackScore::InTime::note(bool found, bool over, bool& open) {
  if (!open || !(found || over)) return;
  open = false;
  decided += 1;
  in_time += found ? 1U : 0U;
}

void TrackScore::note_stay(double t_s, const Target& target, bool found) {
  const auto known = stays_.find(target.id);
  const bool comes = known == stays_.end() || t_s - known->second.last_s > kAwayS;
  if (comes && target.stands()) return;  // nothing moves yet
  Stay& stay = stays_[target.id];
  if (comes) stay = {.since_s = t_s, .last_s = t_s};
  const bool seen_before = stay.last_s == frame_before_s_;
  if (seen_before && !target.stands()) stay.moved_s += t_s - stay.last_s;
  stay.last_s = t_s;
  const double most_s = rules_.soon_s + kRoundOffS;
  soon_.note(found, stay.moved_s > most_s, stay.open);
  soon_by_clock_.note(found, t_s - stay.since_s > most_s, stay.open_by_clock);
}

void TrackScore::add(double t_s, std::span<const Target> targets, std::span<const Hypothesis> tracks) {
  for (const Hypothesis& track : tracks) {
    born_s_.try_emplace(track.id, t_s);
    if (track.moving) moved_.insert(track.id);
  }
  for (const Target& target : targets) note_steady(t_s, target);
  pair_up(targets, tracks);
  std::vector<bool> found(targets.size()), used(tracks.size());
  for (const Pair& p : pairs_) {
    found[p.target] = used[p.track] = true;
    right_.insert(tracks[p.track].id);
    if (targets[p.target].in_view) count(t_s, targets[p.target], tracks[p.track], p.distance_m);
  }
  for (std::size_t k = 0; k < tracks.size(); ++k) false_positives_ += !used[k] && tracks[k].moving ? 1U : 0U;
  for (std::size_t k = 0; k < targets.size(); ++k) {
    if (!targets[k].in_view) continue;
    targets_ += 1;
    note_stay(t_s, targets[k], found[k]);
  }
  frame_before_s_ = t_s;
}

std::size_t TrackScore::false_movers() const {
  return static_cast<std::size_t>(
      std::count_if(moved_.begin(), moved_.end(), [&](std::uint32_t id) { return right_.count(id) == 0; }));
}

StepError greatest_step_error(const std::vector<PosePair>& drive) {
  StepError most;
  for (std::size_t k = 1; k < drive.size(); ++k) {
    const Pose2 off = motion_error(drive[k - 1], drive[k]);
    most.translation_m = std::max(most.translation_m, norm(off.position()));
    most.heading_deg = std::max(most.heading_deg, std::fabs(off.heading) * 180.0 / kPi);
  }
  return most;
}

RelativeError relative_error(const std::vector<PosePair>& drive, double length_m, double every_m) {
  const std::vector<double> way = way_m(drive);
  std::vector<double> percent, degrees;
  double next_start = 0.0;
  for (std::size_t a = 0; a < drive.size(); ++a) {
    if (way[a] < next_start) continue;
    const auto end = std::lower_bound(way.begin(), way.end(), way[a] + length_m);
    if (end == way.end()) break;
    next_start = way[a] + every_m;
    const auto b = static_cast<std::size_t>(end - way.begin());
    const Pose2 off = motion_error(drive[a], drive[b]);
    percent.push_back(100.0 * norm(off.position()) / (way[b] - way[a]));
    degrees.push_back(std::fabs(off.heading) * 180.0 / kPi);
  }
  const std::size_t stretches = percent.size();
  return {stretches, median(percent), median(degrees)};
}

}  // namespace jaywalk::bench
