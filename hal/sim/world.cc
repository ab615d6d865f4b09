#include "hal/sim/world.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "hal/types/errors.h"

namespace jaywalk::sim {
namespace {

constexpr double kWalkRatio = 0.0065 * 60.0;  // m s: a step's length over steps a second
constexpr double kOfTheFoot = 2.0 / 3.0;      // what a shin goes to and fro
// Chosen, not measured: shins in trousers, feet a hand apart, and less than a second from a stride to standing.
constexpr double kLegRadiusM = 0.06;
constexpr double kLegFromMiddleM = 0.1;  // to the side
constexpr double kStepGrowsMps = 1.0;    // a pedestrian starting or stopping changes its steps by this

/// The left foot, in half steps ahead of the middle: it stands for one step and comes forward with the next.
double left_ahead(double steps) {
  const double of_two = steps - 2.0 * std::floor(0.5 * steps);
  return of_two < 1.0 ? 1.0 - 2.0 * of_two : 2.0 * of_two - 3.0;
}

constexpr double kCausedSpeed = 0.05;  // m/s of any point of the outline: a contact at more is the robot's doing
constexpr double kApartAgain = 0.01;   // m: an episode of touching ends at this gap
constexpr double kIntimate_m = 0.45;   // HuNavSim's indicator functions, after Hall 1966
constexpr double kPersonal_m = 1.2;    // the same
constexpr double kOpenGround = 50.0;   // m round the walls; what lies farther out is a slip of unit or origin

bool off_the_map(const Box2& walls, Vec2 p) {
  const Vec2 past{std::max(walls.low.x - p.x, p.x - walls.high.x), std::max(walls.low.y - p.y, p.y - walls.high.y)};
  return !(past.x <= kOpenGround && past.y <= kOpenGround);
}

}  // namespace

void Legs::walk(const MoverTruth& walker, double step_s) noexcept {
  const double speed = norm(walker.velocity), wanted = std::sqrt(kWalkRatio * speed);
  if (wanted > 0.0) steps_ += speed * step_s / wanted;
  step_m_ += std::clamp(wanted - step_m_, -kStepGrowsMps * step_s, kStepGrowsMps * step_s);
}

std::array<Disc, 2> Legs::of(const MoverTruth& walker) const noexcept {
  const Vec2 ahead = direction(walker.heading), left{-ahead.y, ahead.x};
  const Vec2 foot = ahead * (0.5 * kOfTheFoot * step_m_ * left_ahead(steps_)) + left * kLegFromMiddleM;
  return {Disc{walker.position + foot, kLegRadiusM}, Disc{walker.position - foot, kLegRadiusM}};
}

World::World(const Scenario& scenario, std::uint64_t seed)
    : faults_(scenario.faults),
      footprint_(scenario.model.footprint),
      walls_(load_wall_map(scenario.map_kind, scenario.map_file)),
      grid_(walls_, footprint_.inscribed_radius_m(), with_free_places(scenario).start.position(), scenario.goal),
      plant_(scenario.model, scenario.start, seed, scenario.slip, scenario.truth),
      wanderers_({scenario, walls_, grid_}, seed),
      recorded_(scenario.recorded, static_cast<std::uint32_t>(wanderers_.movers().size())),
      social_({scenario, walls_, grid_}, seed,
              static_cast<std::uint32_t>(wanderers_.movers().size() + recorded_.capacity()), wanderers_.movers()) {
  movers_.reserve(wanderers_.movers().size() + recorded_.capacity() + social_.movers().size());
  legs_.resize(movers_.capacity());
  seen_.reserve(2 * movers_.capacity());
  truth_.now = Time{};
  move_movers();
  truth_.contacts = truth_.contacts_caused = 0;  // a pedestrian recorded where the robot starts is no contact of its
  truth_.map_from_robot = plant_.map_from_robot();
}

const Scenario& World::with_free_places(const Scenario& scenario) const {
  const std::string start = scenario.start_place + "the robot's start lies ",
                    goal = scenario.goal_place + "the goal lies ";
  const auto refuse = [&](const std::string& cause, const std::string& remedy) {
    throw StartupError(cause + " of " + scenario.map_file.string(), remedy);
  };
  if (off_the_map(walls_.bounds(), scenario.start.position()))
    refuse(start + "more than 50 m outside the walls", "move robot.start, in metres in the map's frame");
  if (off_the_map(walls_.bounds(), scenario.goal))
    refuse(goal + "more than 50 m outside the walls", "move robot.goal, in metres in the map's frame");
  if (walls_.clearance(footprint_, scenario.start) <= 0.0) refuse(start + "in a wall", "move robot.start");
  const double radius = footprint_.inscribed_radius_m();
  if (walls_.distance(scenario.goal, radius) < radius) refuse(goal + "in a wall or too near one", "move robot.goal");
  return scenario;
}

void World::touch() noexcept {
  if (touching_) return;
  touching_ = true;
  ++truth_.contacts;
  // The outline's fastest point is the corner that a turn speeds up most and that is farthest from the axle.
  const double turn = std::fabs(plant_.twist().w_radps);
  const Vec2 fastest{std::fabs(plant_.twist().v_mps) + turn * footprint_.half_width_m,
                     turn * std::max(footprint_.front_m, footprint_.rear_m)};
  if (norm(fastest) > kCausedSpeed) ++truth_.contacts_caused;
}

/// Walls, wandering and social movers stop the robot. The outline moves at most as far as the middle plus the turn
/// times the outermost point's radius; until that has used up the last exact gap there is nothing to check.
void World::keep_out_of_solids(const Pose2& before) noexcept {
  const Pose2& after = plant_.map_from_robot();
  const double turned = std::fabs(wrap_angle(after.heading - before.heading));
  slack_m_ -= distance(before.position(), after.position()) + turned * footprint_.circumscribed_radius_m();
  if (slack_m_ > 0.0) return;
  if (walls_.clearance(footprint_, after) > 0.0 && gap_to_solid_mover() > 0.0) return;
  touch();
  plant_.stop_at(before);
}

void World::move_movers() noexcept {
  recorded_.place(to_seconds(truth_.now), body());
  gather_movers();
  if (steps_ > 0) {
    const std::span<const MoverTruth> before = movers_;
    wanderers_.step(to_seconds(kMoverStep), body(), before.subspan(wanderers_.movers().size()));
    const Vec2 velocity = direction(plant_.map_from_robot().heading) * plant_.twist().v_mps;
    social_.step(to_seconds(kMoverStep), body(), velocity, before.first(before.size() - social_.movers().size()));
    gather_movers();
  }
  see_movers();
  if (wanderers_.bumped_robot() || social_.bumped_robot()) touch();
  judge_gaps();
  measure_nearness();
  truth_.movers = movers_;
  truth_.forced_movers = wanderers_.forced() + recorded_.forced() + social_.forced();
  truth_.accel_mps2 = (plant_.rim_speed() - rim_speed_) / to_seconds(kMoverStep);
  rim_speed_ = plant_.rim_speed();
}

void World::see_movers() noexcept {
  seen_.clear();
  for (const MoverTruth& m : movers_) {
    if (!m.on_legs) {
      seen_.push_back({m.position, m.radius_m});
      continue;
    }
    Legs& legs = legs_[m.id - 1];
    legs.walk(m, to_seconds(kMoverStep));
    for (const Disc& leg : legs.of(m)) seen_.push_back(leg);
  }
}

void World::judge_gaps() noexcept {
  const double to_wall = walls_.clearance(footprint_, plant_.map_from_robot());
  const double to_solid = gap_to_solid_mover();
  const double to_mover = std::min(to_solid, gap_to(recorded_.movers()));
  const double gap = std::min(to_wall, to_mover);
  slack_m_ = std::min(to_wall, to_solid);
  if (to_mover <= 0.0) touch();
  truth_.clearance_m = touching_ ? 0.0 : gap;
  if (gap > kApartAgain) touching_ = false;
  truth_.mover_clearance_m = to_mover;
}

void World::measure_nearness() noexcept {
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const MoverTruth& m : movers_) nearest_m = std::min(nearest_m, body().gap({m.position, 0.0}));
  SocialMeasures& measures = truth_.social;
  const double step_s = steps_ > 0 ? to_seconds(kMoverStep) : 0.0;
  if (nearest_m < kIntimate_m)
    measures.intimate_s += step_s;
  else if (nearest_m < kPersonal_m)
    measures.personal_s += step_s;
  measures.slowed_m = social_.caused().slowed_m;
  measures.turned_rad = social_.caused().turned_rad;
}

void World::connect_plant() noexcept {
  if (faults_.empty()) return;
  const auto sign = [this](FaultKind reversed) { return fault_active(reversed) ? -1.0 : 1.0; };
  const double both = sign(FaultKind::kBothMotorsReversed);
  const double grip = fault_active(FaultKind::kNoGrip) ? 0.0 : 1.0;
  plant_.grip(fault_active(FaultKind::kWheelSlip) ? grip * kLostGrip : grip, grip);
  plant_.connect({.left_motor = both * sign(FaultKind::kLeftMotorReversed),
                  .right_motor = both,
                  .left_ground = sign(FaultKind::kLeftWheelReversed),
                  .swapped = fault_active(FaultKind::kWheelsSwapped),
                  .left_stuck = fault_active(FaultKind::kLeftWheelStuck)});
}

void World::carry_robot() noexcept {
  for (const FaultSpec& fault : faults_) {
    if (fault.kind != FaultKind::kCarried || !fault.active(to_seconds(truth_.now))) continue;
    const double steps = std::max(std::round(fault.for_s / to_seconds(kWorldStep)), 1.0);
    const double done = std::floor((to_seconds(truth_.now) - fault.at_s) / to_seconds(kWorldStep) + 1e-6);
    const Pose2& at = plant_.map_from_robot();
    const double lifted_heading = at.heading - fault.way.heading * done / steps;
    const Vec2 step = Transform2({0.0, 0.0, lifted_heading}).rotate(fault.way.position() * (1.0 / steps));
    plant_.carry_to({at.x + step.x, at.y + step.y, wrap_angle(at.heading + fault.way.heading / steps)});
  }
}

void World::step() noexcept {
  truth_.now += kWorldStep;
  const Pose2 before = plant_.map_from_robot();
  connect_plant();
  plant_.step(to_seconds(kWorldStep), truth_.now);
  carry_robot();
  keep_out_of_solids(before);
  if (++steps_ % kStepsAMove == 0) {
    plant_.change_slip(to_seconds(kMoverStep));
    move_movers();
  }
  truth_.map_from_robot = plant_.map_from_robot();
  truth_.twist = plant_.twist();
}

}  // namespace jaywalk::sim
