#include "hal/sim/movers.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "hal/shown_text.h"
#include "hal/text_file.h"
#include "hal/types/errors.h"

namespace jaywalk::sim {
namespace {

constexpr double kRoomToWalls = 0.3;   // m between a mover's edge and what is near when it is placed
constexpr double kRoomToRobot = 2.0;   // m from the robot's start
constexpr double kRoomToGoal = 1.0;    // m from the goal
constexpr double kRoomToMovers = 0.5;  // m between edges
constexpr int kPlacements = 20000;     // tries for one mover: 16 find room on maps that are 99 % walls
constexpr int kHeadingsAStep = 16;     // tries for a free heading before it looks again in the next step
constexpr double kTouch = 0.01;        // m: nearer than this a mover walks on into nobody

bool has_room(Vec2 p, const Ground& ground, double radius_m, std::span<const MoverTruth> placed) {
  const double to_walls = radius_m + kRoomToWalls;
  if (distance(p, ground.scenario.start.position()) < kRoomToRobot + radius_m) return false;
  if (distance(p, ground.scenario.goal) < kRoomToGoal + radius_m) return false;
  for (const MoverTruth& other : placed)
    if (distance(p, other.position) < radius_m + other.radius_m + kRoomToMovers) return false;
  return ground.grid.reachable(p) && ground.walls.distance(p, to_walls) >= to_walls;
}

}  // namespace

Vec2 free_place(const Ground& ground, const Box2& within, double radius_m, std::span<const MoverTruth> placed,
                Random& random) {
  for (int k = 0; k < kPlacements; ++k) {
    const double x = random.uniform(within.low.x, within.high.x), y = random.uniform(within.low.y, within.high.y);
    if (has_room({x, y}, ground, radius_m, placed)) return {x, y};
  }
  throw StartupError(ground.scenario.map_file.string() + ": no room for mover " + std::to_string(placed.size() + 1),
                     "ask for fewer or smaller movers");
}

Wanderers::Wanderers(const Ground& ground, std::uint64_t seed) : walls_(ground.walls) {
  Random random(seed, Purpose::kPlacement);
  for (const WanderSpec& spec : ground.scenario.wanderers)
    for (int k = 0; k < spec.count; ++k) {
      const Vec2 position = free_place(ground, walls_.bounds(), spec.radius_m, movers_, random);
      place(spec, position, seed, static_cast<std::uint32_t>(movers_.size() + 1), random);
    }
}

bool Wanderers::add(const Ground& ground, std::uint64_t seed, std::uint32_t id, std::span<const MoverTruth> placed) {
  const std::vector<WanderSpec>& kinds = ground.scenario.wanderers;
  const WanderSpec spec = kinds.empty() ? WanderSpec{} : kinds.front();
  Random random(seed, Purpose::kPlacement, id);
  try {
    place(spec, free_place(ground, walls_.bounds(), spec.radius_m, placed, random), seed, id, random);
  } catch (const StartupError&) {
    return false;
  }
  return true;
}

void Wanderers::place(const WanderSpec& spec, Vec2 position, std::uint64_t seed, std::uint32_t id, Random& random) {
  const double heading = random.uniform(-kPi, kPi);
  movers_.push_back(
      {.id = id, .position = position, .heading = heading, .radius_m = spec.radius_m, .on_legs = spec.legs});
  minds_.push_back({.speed_mps = spec.speed_mps,
                    .turn_rate_radps = spec.turn_rate_radps,
                    .spontaneous_turns_hz = spec.spontaneous_turns_hz,
                    .random = Random(seed, Purpose::kWanderer, id)});
}

Wanderers::Blocker Wanderers::ahead(std::size_t self, double heading, const Surroundings& near) const noexcept {
  const MoverTruth& mover = movers_[self];
  const Zone zone{mover.position, direction(heading), mover.radius_m + kWanderZone};
  bool wall = false;
  walls_.for_each_near(zone.apex, zone.reach_m, [&](const auto& shape) { wall = wall || zone.meets(shape); });
  if (wall) return Blocker::kOther;
  const auto in_zone = [&](const MoverTruth& other) {
    return other.id != mover.id && zone.meets(Disc{other.position, other.radius_m});
  };
  if (std::any_of(movers_.begin(), movers_.end(), in_zone)) return Blocker::kOther;
  if (std::any_of(near.others.begin(), near.others.end(), in_zone)) return Blocker::kOther;
  return near.robot.in(zone) ? Blocker::kRobot : Blocker::kNothing;
}

/// Whom the mover would run into from the side, where its zone does not look; walls cannot be met so
/// (see docs/reference/scenarios.md). Only coming nearer counts, so that two that touch can part.
Wanderers::Blocker Wanderers::touched(std::size_t self, Vec2 next, const Surroundings& near) const noexcept {
  const MoverTruth& mover = movers_[self];
  const auto runs_into = [&](const MoverTruth& other) {
    const double after = distance(next, other.position);
    return other.id != mover.id && after < mover.radius_m + other.radius_m + kTouch &&
           after < distance(mover.position, other.position);
  };
  if (std::any_of(movers_.begin(), movers_.end(), runs_into)) return Blocker::kOther;
  if (std::any_of(near.others.begin(), near.others.end(), runs_into)) return Blocker::kOther;
  return near.robot.is_run_into(mover.position, {next, mover.radius_m}) ? Blocker::kRobot : Blocker::kNothing;
}

void Wanderers::halt(std::size_t self, Blocker blocker) noexcept {
  MoverTruth& mover = movers_[self];
  mover.velocity = {};
  minds_[self].activity = Activity::kChoosing;
  if (blocker == Blocker::kRobot && !mover.forced) {
    mover.forced = true;
    ++forced_;
  }
}

void Wanderers::walk(std::size_t self, double step_s, const Surroundings& near) noexcept {
  MoverTruth& mover = movers_[self];
  Mind& mind = minds_[self];
  const bool whim = mind.random.uniform() < mind.spontaneous_turns_hz * step_s;
  const Blocker in_zone = ahead(self, mover.heading, near);
  if (whim || in_zone != Blocker::kNothing) return halt(self, in_zone);
  const Vec2 velocity = direction(mover.heading) * mind.speed_mps;
  const Vec2 next = mover.position + velocity * step_s;
  const Blocker beside = touched(self, next, near);
  if (beside == Blocker::kRobot) bumped_robot_ = true;
  if (beside != Blocker::kNothing) return halt(self, beside);
  mover.position = next;
  mover.velocity = velocity;
  mover.forced = false;
}

void Wanderers::choose(std::size_t self, const Surroundings& near) noexcept {
  Mind& mind = minds_[self];
  for (int k = 0; k < kHeadingsAStep; ++k) {
    const double heading = mind.random.uniform(-kPi, kPi);
    if (ahead(self, heading, near) != Blocker::kNothing) continue;
    mind.new_heading = heading;
    mind.activity = Activity::kTurning;
    return;
  }
}

void Wanderers::turn(std::size_t self, double step_s) noexcept {
  MoverTruth& mover = movers_[self];
  Mind& mind = minds_[self];
  const double left = wrap_angle(mind.new_heading - mover.heading);
  const double most = mind.turn_rate_radps * step_s;
  if (std::fabs(left) <= most) {
    mover.heading = mind.new_heading;
    mind.activity = Activity::kWalking;
  } else {
    mover.heading = wrap_angle(mover.heading + (left > 0.0 ? most : -most));
  }
}

void Wanderers::step(double step_s, const RobotBody& robot, std::span<const MoverTruth> others) noexcept {
  bumped_robot_ = false;
  const Surroundings near{robot, others};
  for (std::size_t self = 0; self < movers_.size(); ++self) {
    switch (minds_[self].activity) {
      case Activity::kWalking: walk(self, step_s, near); break;
      case Activity::kChoosing: choose(self, near); break;
      case Activity::kTurning: turn(self, step_s); break;
    }
  }
}

void RecordedMovers::load(const RecordedSpec& spec) {
  LineReader reader(spec.file, "write rows of t_s,id,x_m,y_m below a line that says so");
  std::map<double, std::vector<Sample>> by_id;
  double begin = 1e9, end = -1e9;
  reader.read_table("t_s,id,x_m,y_m", 4, [&](const std::vector<double>& v, const std::string& line) {
    const bool sound = !v.empty() && std::fabs(v[0]) < 1e7 && std::fabs(v[2]) < 1e6 && std::fabs(v[3]) < 1e6 &&
                       v[1] == std::floor(v[1]) && std::fabs(v[1]) < 1e15;
    if (!sound) reader.refuse("\"" + shown(line) + "\" is not four numbers");
    by_id[v[1]].push_back({v[0], Vec2{v[2], v[3]} + spec.offset});
    begin = std::min(begin, v[0]);
    end = std::max(end, v[0]);
  });
  if (by_id.empty()) reader.refuse("holds nobody");
  for (auto& [id, samples] : by_id) {
    std::stable_sort(samples.begin(), samples.end(), [](const Sample& a, const Sample& b) { return a.t_s < b.t_s; });
    const MoverTruth truth{.position = samples.front().position, .radius_m = spec.radius_m, .on_legs = spec.legs};
    people_.push_back({std::move(samples), 1, &spec, begin, end - begin, truth});
  }
}

/// Sets the person's truth; false when not there at this time.
bool RecordedMovers::move(Person& person, double now_s) noexcept {
  double t = person.begin_s + now_s - person.spec->start_at_s;
  if (person.spec->loop && person.period_s > 0.0 && t >= person.begin_s)
    t = person.begin_s + std::fmod(t - person.begin_s, person.period_s);
  const auto& samples = person.samples;
  if (samples.size() < 2 || t < samples.front().t_s || t >= samples.back().t_s) return false;
  if (samples[person.next - 1].t_s > t) person.next = 1;  // the recording began anew
  while (samples[person.next].t_s <= t) ++person.next;
  const Sample& before = samples[person.next - 1];
  const Sample& after = samples[person.next];
  const Vec2 velocity = (after.position - before.position) * (1.0 / (after.t_s - before.t_s));
  person.truth.position = before.position + velocity * (t - before.t_s);
  person.truth.velocity = velocity;
  if (dot(velocity, velocity) > 0.0) person.truth.heading = atan2(velocity.y, velocity.x);
  return true;
}

void RecordedMovers::place(double now_s, const RobotBody& robot) noexcept {
  present_.clear();  // room for all was taken at construction
  for (Person& person : people_) {
    MoverTruth& truth = person.truth;
    const bool was_forced = truth.forced;
    truth.forced = false;
    if (!move(person, now_s)) continue;
    truth.forced = robot.in({truth.position, direction(truth.heading), truth.radius_m + kRecordedZone});
    if (truth.forced && !was_forced) ++forced_;
    present_.push_back(truth);
  }
}

}  // namespace jaywalk::sim
