#include "hal/sim/social_walkers.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace jaywalk::sim::social {
namespace {

// Section III of the paper.
constexpr double kWalkerPotential_m2ps2 = 2.1, kWalkerRange_m = 0.3;  // V0, sigma
constexpr double kWallPotential_m2ps2 = 10.0, kWallRange_m = 0.2;     // U0, R
constexpr double kStep_s = 2.0;                                       // Delta t: how far ahead others are expected
constexpr double kFar_m = 3.0;                                        // b beyond which a force is below 0.0005 m/s2
constexpr double kUnseen = 0.5;                                       // c
constexpr double kLeast_m = 0.01;                                     // outlines are never taken for nearer

}  // namespace

/// b is the semi-minor axis of the ellipse through `apart_m` with foci at the other pedestrian now and Delta t later;
/// the force is -grad V0 exp(-b / sigma).
Vec2 away_from_walker(Vec2 apart_m, Vec2 velocity_mps) noexcept {
  const Vec2 step = velocity_mps * kStep_s, from_next = apart_m - step;
  const double now = norm(apart_m), next = std::max(norm(from_next), kLeast_m), sum = now + next;
  const double b = std::max(0.5 * std::sqrt(std::max(sum * sum - dot(step, step), 0.0)), kLeast_m);
  if (b > kFar_m) return {};
  const Vec2 gradient_of_b = (apart_m * (1.0 / now) + from_next * (1.0 / next)) * (sum / (4.0 * b));
  return gradient_of_b * (kWalkerPotential_m2ps2 / kWalkerRange_m * exp(-b / kWalkerRange_m));
}

Vec2 away_from_wall(Vec2 apart_m) noexcept {
  const double gap = norm(apart_m);
  return apart_m * (kWallPotential_m2ps2 / kWallRange_m * exp(-gap / kWallRange_m) / gap);
}

Vec2 as_seen(Vec2 force, Vec2 ahead) noexcept { return in_sight(ahead, force * -1.0) ? force : force * kUnseen; }

Vec2 between_outlines(Vec2 apart_m, double radii_m) noexcept {
  const double centres = norm(apart_m);
  if (centres < kLeast_m) return {kLeast_m, 0.0};
  return apart_m * (std::max(centres - radii_m, kLeast_m) / centres);
}

}  // namespace jaywalk::sim::social

namespace jaywalk::sim {
namespace {

constexpr double kMostGoalWay_m = 10.0;   // to the next goal, at most
constexpr double kLeastGoalWay_m = 2.0;   // to the next goal, at least
constexpr double kThere_m = 0.5;          // from a goal that counts as reached
constexpr double kPatience = 2.0;         // time until another goal is chosen, over the time that the way takes
constexpr int kGoalTries = 16;            // random places looked at in a step
constexpr double kWallReach_m = 2.0;      // a wall's force is below 0.003 m/s2 beyond it
constexpr double kGroupRoom_m = 1.5;      // from the first of a group to the places of the others
constexpr double kSpeedLimits_std = 2.0;  // wished speeds are drawn within so many standard deviations
constexpr double kLooksAhead_mps = 0.1;   // slower than this a pedestrian keeps its heading

// Moussaid and others 2010, "The walking behaviour of pedestrian social groups", PLoS ONE 5 (4): cohesion alone.
constexpr double kCohesion_mps2 = 3.0;  // beta 2

/// Distance of the robot at which HuNavSim's reactions begin, and how long they last.
struct ReactionRule {
  double within_m = 0.0, lasts_s = 0.0;
};
constexpr std::array<ReactionRule, 5> kRules{{{}, {4.0, 30.0}, {10.0, 40.0}, {3.0, 40.0}, {}}};
constexpr double kCuriousStop_m = 1.5;      // a curious pedestrian stands at this from the robot's middle
constexpr double kCuriousSlows_m = 10.0;    // its speed is the wished one times the distance over this
constexpr double kAfraidMost_mps = 0.6;     // an afraid pedestrian walks no faster
constexpr double kFear_m2ps2 = 20.0 * 0.2;  // times 1 / distance: its further force
// HuNavSim has no hurried one: it walks at the greatest speed, and heeds the robot as a wall, as the impassive does.

/// Turns the nearest point of a wall into the way from it.
Vec2 away_from(Vec2 p, const WallSegment& wall) { return p - nearest_on_segment(p, wall.from, wall.to); }
Vec2 away_from(Vec2 p, const Disc& pillar) { return social::between_outlines(p - pillar.centre, pillar.radius_m); }

}  // namespace

SocialWalkers::SocialWalkers(const Ground& ground, std::uint64_t seed, std::uint32_t last_id,
                             std::span<const MoverTruth> placed)
    : walls_(ground.walls), grid_(ground.grid) {  // ids are unique, and so are their streams of random numbers
  std::vector<MoverTruth> all(placed.begin(), placed.end());
  for (const SocialSpec& spec : ground.scenario.social) {
    for (int k = 0; k < spec.count; ++k) {
      const std::size_t self = movers_.size(), leader = self - static_cast<std::size_t>(k % spec.group);
      const std::uint32_t id = last_id + static_cast<std::uint32_t>(self) + 1;
      place(spec, ground, leader, all, Random(seed, Purpose::kWanderer, id));
      movers_.back().id = id;
      all.push_back(movers_.back());
    }
  }
}

void SocialWalkers::place(const SocialSpec& spec, const Ground& ground, std::size_t leader,
                          std::span<const MoverTruth> placed, Random random) {
  const std::size_t self = movers_.size();
  Box2 within = walls_.bounds();
  if (leader != self) {
    const Vec2 room{kGroupRoom_m, kGroupRoom_m}, middle = movers_[leader].position;
    within = {middle - room, middle + room};
    ++minds_[leader].followers;
  }
  const Vec2 position = free_place(ground, within, spec.radius_m, placed, random);
  const double heading = random.uniform(-kPi, kPi);
  const double spread = std::clamp(random.normal(), -kSpeedLimits_std, kSpeedLimits_std) * social::kSpeedSpread;
  const bool mixed = spec.reaction == Reaction::kMixed;
  movers_.push_back({.position = position, .heading = heading, .radius_m = spec.radius_m, .on_legs = spec.legs});
  minds_.push_back({.wished_mps = spec.speed_mps * (1.0 + spread),
                    .reaction = mixed ? static_cast<Reaction>(self % kRules.size()) : spec.reaction,
                    .leader = leader,
                    .goal = position,
                    .random = random});
  if (minds_.back().reaction == Reaction::kHurried) minds_.back().wished_mps *= social::kMostSpeed;
}

void SocialWalkers::choose_goal(std::size_t self) noexcept {
  Mind& mind = minds_[self];
  const Vec2 here = movers_[self].position;
  if (mind.leader != self) mind.goal = minds_[mind.leader].goal;
  if (mind.leader != self || (now_s_ < mind.give_up_s && distance(here, mind.goal) > kThere_m)) return;
  mind.goal = here;
  for (int k = 0; k < kGoalTries; ++k) {
    const Vec2 ahead = direction(mind.random.uniform(-kPi, kPi));
    const double way_m = mind.random.uniform(kLeastGoalWay_m, kMostGoalWay_m);
    if (!grid_.line_is_free(here, here + ahead * way_m)) continue;
    mind.goal = here + ahead * way_m;
    mind.give_up_s = now_s_ + kPatience * way_m / mind.wished_mps;
    return;
  }
}

/// HuNavSim's condition, and no wall between.
bool SocialWalkers::reacts(std::size_t self, const Robot& robot, double step_s) noexcept {
  Mind& mind = minds_[self];
  const MoverTruth& mover = movers_[self];
  const ReactionRule& rule = kRules[static_cast<std::size_t>(mind.reaction)];
  const Vec2 to_robot = robot.middle - mover.position;
  const double far_m = norm(to_robot);
  if (mind.reacted_s >= rule.lasts_s || far_m > rule.within_m) return false;
  if (!social::in_sight(direction(mover.heading), to_robot)) return false;
  if (far_m > 0.0 && walls_.cast(mover.position, to_robot * (1.0 / far_m), far_m) < far_m) return false;
  mind.reacted_s += step_s;
  return true;
}

Vec2 SocialWalkers::wish_beside(std::size_t self, const Robot& robot, double step_s) noexcept {
  Mind& mind = minds_[self];
  MoverTruth& mover = movers_[self];
  const Vec2 to_goal = mind.goal - mover.position, away = mover.position - robot.middle;
  const double way_m = norm(to_goal), far_m = norm(away);
  const Vec2 ahead = way_m > 0.0 ? to_goal * (1.0 / way_m) : direction(mover.heading);
  const Vec2 unseen = way_m > 0.0 ? ahead * mind.wished_mps : Vec2{};
  const double gap_m = robot.body.gap({mover.position, mover.radius_m});
  const Vec2 apart = social::between_outlines(away, far_m - gap_m);
  const bool hurries = mind.reaction == Reaction::kHurried;
  Vec2 force = hurries ? social::away_from_wall(apart)
                       : social::as_seen(social::away_from_walker(apart, robot.velocity_mps), ahead);
  Vec2 wished = unseen;
  if (reacts(self, robot, step_s)) {
    if (mind.reaction == Reaction::kAfraid) {
      wished = ahead * std::min(mind.wished_mps, kAfraidMost_mps);
      force = force + apart * (kFear_m2ps2 / (norm(apart) * std::max(far_m - mover.radius_m, mover.radius_m)));
    } else {
      const bool comes = mind.reaction == Reaction::kCurious && far_m > kCuriousStop_m;
      wished = away * (comes ? -mind.wished_mps / kCuriousSlows_m : 0.0);
      mover.heading = atan2(-away.y, -away.x);
    }
  }
  const Vec2 caused = force + (wished - unseen) * (1.0 / social::kRelaxation_s);
  caused_.slowed_m += std::max(-dot(caused, ahead), 0.0) * social::kRelaxation_s * step_s;
  caused_.turned_rad += std::fabs(cross(ahead, caused)) / mind.wished_mps * step_s;
  return force + social::towards(wished, mover.velocity);
}

Vec2 SocialWalkers::force_of_others(std::size_t self, std::span<const MoverTruth> others) const noexcept {
  const MoverTruth& mover = movers_[self];
  const Vec2 ahead = direction(mover.heading);
  Vec2 sum{};
  for (const std::span<const MoverTruth> all : {std::span<const MoverTruth>(movers_), others}) {
    for (const MoverTruth& other : all) {
      if (other.id == mover.id) continue;
      const Vec2 apart = social::between_outlines(mover.position - other.position, mover.radius_m + other.radius_m);
      sum = sum + social::as_seen(social::away_from_walker(apart, other.velocity), ahead);
    }
  }
  return sum;
}

/// Of the nearest point of all walls alone, as the paper's of one border.
Vec2 SocialWalkers::force_of_walls(const MoverTruth& mover) const noexcept {
  Vec2 nearest{kWallReach_m, 0.0};
  walls_.for_each_near(mover.position, kWallReach_m, [&](const auto& shape) {
    const Vec2 apart = away_from(mover.position, shape);
    if (dot(apart, apart) < dot(nearest, nearest)) nearest = apart;
  });
  return social::away_from_wall(social::between_outlines(nearest, mover.radius_m));
}

/// Leads to the group's middle from farther than half a metre for each of the others.
Vec2 SocialWalkers::force_of_group(std::size_t self) const noexcept {
  const std::size_t leader = minds_[self].leader, others = minds_[leader].followers;
  Vec2 sum{};
  for (std::size_t k = leader; k <= leader + others; ++k) sum = sum + movers_[k].position;
  const Vec2 to_middle = sum * (1.0 / static_cast<double>(others + 1)) - movers_[self].position;
  const double far_m = norm(to_middle);
  return far_m > 0.5 * static_cast<double>(others) ? to_middle * (kCohesion_mps2 / far_m) : Vec2{};
}

void SocialWalkers::walk(std::size_t self, double step_s, const RobotBody& robot) noexcept {
  MoverTruth& mover = movers_[self];
  const double most_mps = social::kMostSpeed * minds_[self].wished_mps;
  Vec2 velocity = mover.velocity + minds_[self].force * step_s;
  if (norm(velocity) > most_mps) velocity = velocity * (most_mps / norm(velocity));
  if (robot.is_run_into(mover.position, {mover.position + velocity * step_s, mover.radius_m})) {
    bumped_robot_ = true;
    velocity = {};
  }
  mover.velocity = velocity;
  mover.position = mover.position + velocity * step_s;
  if (norm(velocity) > kLooksAhead_mps) mover.heading = atan2(velocity.y, velocity.x);
  const bool was_forced = mover.forced;
  mover.forced = robot.in({mover.position, direction(mover.heading), mover.radius_m + kRecordedZone});
  if (mover.forced && !was_forced) ++forced_;
}

void SocialWalkers::step(double step_s, const RobotBody& body, Vec2 robot_velocity_mps,
                         std::span<const MoverTruth> others) noexcept {
  now_s_ += step_s;
  bumped_robot_ = false;
  const Footprint& outline = body.footprint;
  const Robot robot{body, body.map_from_robot * Vec2{0.5 * (outline.front_m - outline.rear_m), 0.0},
                    robot_velocity_mps};
  for (std::size_t self = 0; self < movers_.size(); ++self) {
    choose_goal(self);
    minds_[self].force = wish_beside(self, robot, step_s) + force_of_others(self, others) +
                         force_of_walls(movers_[self]) + force_of_group(self);
  }
  for (std::size_t self = 0; self < movers_.size(); ++self) walk(self, step_s, body);
}

}  // namespace jaywalk::sim
