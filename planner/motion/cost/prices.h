#pragma once
// All prices of a trajectory: seconds that a passenger would give not to have it. One table, in the order of the terms.
//
// Set on a prototype (maps 3 and 4, seeds 9001 to 9010) where no other data is named. "Sensitivity" is what another
// value did where it was tried; none is known where none is named.

namespace jaywalk::motion::price {

// Conflict with a mover, in a share of the sampled futures (mover_cost.h).
/// s, each future's first conflict, and as much again for touching (docs/explanation/decisions/motion-prices.md: 36 of
/// 48 runs reached, 35 without the second). Half of it after lost time: 12 of 37 runs reached, not 15, and 17 forced a
/// mover, not 8 (decision motion-prices).
inline constexpr float kConflict = 200.0F;
/// Conflict's price, s: the time in which a waiting robot would be in a mover's way once, from kLeastConflict to
/// kConflict; movers walk at their speeds within kAboutM, over a strip of kMetWidthM. At 100 and 70 the strict rule was
/// kept in 23 and 21 of 24 runs (crossing.toml, 16 movers, seeds 101 to 124; at 45 and kWound 2 in 20), 29 and 32 of 32
/// (maps 1 to 4, 16 movers, seeds 9400 to 9431), 94 of 100 and 81 of 89 (seeds 4001 to 4025).
inline constexpr float kLeastConflict = 100.0F, kAboutM = 5.0F, kMetWidthM = 1.6F;
/// Share of the contact price at rest, and the speed of the body's edge, m/s, from which it is whole; linear between.
/// The same for forcing stopped the robot in people's lanes (11 of 16 runs strict, not 13).
inline constexpr float kTouchedSlowly = 0.2F, kTouchedAtMps = 0.6F;
/// After kYieldsForS lost seconds (StallState) the robot asks people to let it pass: the price of a conflict ahead is
/// divided by 1 + (lost - kYieldsForS) / kYieldsLessS. WORLDS rooms, wheelchair, seeds 6401 to 6424: without this rule
/// 15 of 24 runs arrived, 5 strict, mean 67 s; with 20 s 19, 6, 60 s; with 8 s 20, 7, 55 s. With 8 s 85 of 100 runs
/// were strict among 16 movers (maps 1 to 4, seeds 4001 to 4025), 94 without. A higher price of seconds instead made
/// touching relatively cheap: the driving robot touched in 2 of 24 runs.
inline constexpr float kYieldsForS = 20.0F, kYieldsLessS = 0.5F;
inline constexpr float kWonBack = 2.0F, kMostLostS = 60.0F;  ///< of StallState::lost_s; no other values were tried
inline constexpr float kConflictFadesS = 4.0F;  ///< ahead by so much it counts less by a factor e: decided on again
/// Of a conflict with a mover that has stood for long: should it set out, the robot sees that before it drives on
/// (decision standing-pedestrians).
inline constexpr float kStandingWeight = 0.1F;

// Nearness to movers (mover_cost.h): each look, 0.2 s.
inline constexpr float kNearMover = 0.15F;  ///< a square metre within the comfort distance
/// A m/s faster beside a standing mover than the gap within a second, or than kPoliteMps (decision
/// standing-pedestrians). At 6 a wheelchair passed at 0.58 m/s, 0.3 m off, at 12 at 0.39 m/s (WORLDS passages, seed
/// 331, 1.8 m wide).
inline constexpr float kTooFast = 12.0F;
inline constexpr float kPoliteMps = 0.2F;

// Surfaces (ground_cost.h).
inline constexpr float kContact = 500.0F, kNearContact = 1000.0F;  ///< each step in a surface; nearer than kContactM
inline constexpr float kContactM = 0.03F;                          ///< pose and map err
inline constexpr float kNearWall = 4.0F, kNearWallM = 0.15F;       ///< a second at full speed, at the body's edge
inline constexpr float kByWall = 0.6F,
                       kByWallM = 0.28F;  ///< the same, farther off; not when steered (decision motion-prices)

// What the supervisor would brake for (ground_cost.h).
/// A m/s that it takes away near surfaces. The former price, 40 s for all of the speed at once, gave the same runs
/// within noise (paired: 11 runs of maps, 6 rooms, 8 worlds of posts, 4 doors, 24 encounters).
inline constexpr float kTakenAway = 4.0F;
inline constexpr float kBlindRim =
    10.0F;  ///< a m/s that the supervisor would take away, each step (decision motion-prices)

// Ground that was never seen (ground_cost.h).
inline constexpr float kUnseen = 40.0F;        ///< a second, with all of the rim
inline constexpr float kUnseenFadesM = 0.6F;   ///< after driving on so far it has been seen, most likely
inline constexpr float kUnseenDared = 0.15F;   ///< a second, where the only way leads there,
inline constexpr float kUnseenTurned = 10.0F;  ///< and for each rad/s
/// The robot treats ground within this distance of its axle as seen. Without this rule a wheelchair approached a
/// standing pedestrian to 0.40 m (passage.toml, seed 2; 0.5 m wanted).
inline constexpr float kStoodOnM = 0.5F;

// Comfort (ride_cost.h); 16 movers, maps 1 to 4, seeds 9001 to 9005 (decision motion-prices).
inline constexpr float kAccel = 2.0F, kTurnAccel = 2.0F;  ///< a squared change of m/s, rad/s in a step
/// A squared rad/s, m/s2, each step. kTurning 0.03 changed nothing beyond noise: 3 runs with a loop, not 2, of 32 (maps
/// 1 to 4, 16 movers, seeds 9301 to 9308).
inline constexpr float kTurning = 0.01F, kSideways = 0.03F;
inline constexpr float kBrake = 3.0F;  ///< a squared change of what the brake takes, m/s2: when it bites, and is let go
inline constexpr float kBackward = 0.02F;  ///< each step
/// Turning to the other side than last. At 0.6 or 1.0 the robot did so 5.2 to 7 times a minute, not 5 (decision
/// motion-prices); without it 11.8 times, not 5.3, with 30 and 28 of 32 runs strict (maps 1 to 4, 16 movers, seeds 9400
/// to 9407).
inline constexpr float kReversal = 1.5F;
/// Changes of speed and side are worth so much way: a faster robot drives it sooner.
inline constexpr float kPricedAtMps = 0.6F;

// Time (ride_cost.h).
/// A second until it gets on, for each that it has not (decision motion-prices). Without it 34.8 s were lost, not 29.0
/// (the same 32 runs), and 48 of 50 worlds of posts reached, not 49 (WORLDS posts, seed 331).
inline constexpr float kImpatience = 0.25F;
inline constexpr float kMostStoodS =
    4.0F;  ///< at most so many. Fewer beside movers: 37 of 100 runs, not 46 (decision motion-prices)
/// The same with no pedestrian about: BARN's score rose from 0.332 to 0.358 (seed 706). Used beside pedestrians that
/// have stood for 4 s as well, it made a driving wheelchair touch a pedestrian (WORLDS rooms, seed 6214).
inline constexpr float kMostAloneS = 12.0F;
/// Price of each radian of net turn beyond half a turn since the robot last made progress: it turns back rather than
/// right round. Without it 7 of 176 encounters (WORLDS encounters, seed 860: rooms, corridors) had a loop, at 2 none;
/// at 2 and without kReversal 1, and 5 of 32 runs among 16 movers, not 2 (decision motion-prices). At 2 and 6 the way
/// was at most 1.87 and 1.33 of the shortest, with a loop in 1 and 0 of 24 runs (crossing.toml, 16 movers, seeds 101 to
/// 124, kLeastConflict 70).
inline constexpr float kWound = 6.0F;
/// At rest it forgets so much of that net turn, rad/s. Without it a wheelchair that had turned aside by 3.9 rad for a
/// walker stood for ever in a room that was empty by then: each way on was a circle.
inline constexpr float kUnwindsRadps = 0.3F;
inline constexpr float kArrivedEarly = 0.5F;  ///< taken back at the goal
/// So far ahead and back the guide is asked for what facing away costs: 2 s at most. At 3 s 17 of 20 runs (decision
/// motion-prices).
inline constexpr float kFacingM = 0.35F;
inline constexpr float kFacesRad = 0.05F,
                       kFacesRadps = 0.15F;      ///< off the heading wanted at the goal, at most; turning: there
inline constexpr float kTurnAtGoalRadps = 0.6F;  ///< on the spot, as a passenger likes it
inline constexpr float kMostTimeToGoS = 500.0F;  ///< where no way is known

}  // namespace jaywalk::motion::price
