#include "planner/paper/paper.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "planner/cost_to_go/nearest_surfaces.h"
#include "planner/motion/twist_ramp.h"
#include "planner/paper/executor.h"
#include "planner/paper/paper_planner.h"

namespace jaywalk::paper {
namespace {
constexpr double kLookAhead_m = 0.35;          // at rest; half a robot's length
constexpr double kLookAhead_s = 0.7;           // plus so much travel
constexpr double kTurnInPlaceAbove_rad = 1.0;  // looking further away than this, turn before driving
constexpr double kTurnGain_per_s = 2.0;        // turn in place at this rate a radian of error

constexpr double kFarthest_m = 1e6;  // m, m/s, and their squares: what single precision can hold

cell::AxisState axis(double position, double velocity, const AxisCovariance& p, double cell_m) {
  const auto scaled = [&](double value, double unit) { return static_cast<float>(value / unit); };
  const double square = cell_m * cell_m;
  return {static_cast<float>(position), scaled(velocity, cell_m), scaled(p.pp, square), scaled(p.pv, square),
          scaled(p.vv, square)};
}

/// Whether single precision can hold them: no NaN, nothing beyond a million.
bool are_plausible(std::initializer_list<double> values) {
  return std::all_of(values.begin(), values.end(), [](double v) { return std::fabs(v) <= kFarthest_m; });
}

class PathMotion final : public motion::Motion {
 public:
  explicit PathMotion(const motion::MotionSetup& setup)
      : limits_(setup.model.limits), tick_s_(setup.tick_s), ramp_(setup.model.limits) {}

  void observe(const motion::World& world, const motion::Intent&) noexcept override {
    // Without a path it would go straight on.
    status_.rests_on = world.plan.status == PlanStatus::kOk ? world.plan.stamp : kNever;
  }
  [[nodiscard]] Twist2 command(const motion::World& world, const motion::Intent& intent) noexcept override {
    ramp_.follow(world.driven);
    return ramp_.toward(target(world, intent), tick_s_);
  }
  void decide(const motion::World&, const motion::Intent&) noexcept override {}
  [[nodiscard]] motion::MotionStatus status() const noexcept override { return status_; }
  [[nodiscard]] PlanRequest request(const motion::World& world) const noexcept override {
    return {.stamp = world.scan.stamp,
            .map_from_robot = world.map_from_robot,
            .goal_in_map = world.input.goal_in_map,
            .speed_mps = limits_.max_speed_mps,
            .still = &world.perceived.still,
            .moving = world.perceived.moving,
            .standing = world.perceived.standing};
  }

 private:
  [[nodiscard]] Twist2 target(const motion::World& world, const motion::Intent& intent) const noexcept {
    if (intent.kind != motion::Intent::Kind::kGoal) return {};
    const double cruise = limits_.max_speed_mps, most_radps = limits_.max_turn_radps;
    if (world.plan.path.empty()) return {cruise, 0.0};
    const double v_now = std::max(world.driven.v_mps, 0.0);
    const Pose2& here = world.map_from_robot;
    const Vec2 aim = inverse(here) * look_ahead(world.plan.path, here.position(), kLookAhead_m + kLookAhead_s * v_now);
    const double bearing = atan2(aim.y, aim.x);
    if (std::fabs(bearing) > kTurnInPlaceAbove_rad)
      return {cruise, std::clamp(kTurnGain_per_s * bearing, -most_radps, most_radps)};
    // The circle through here and the aim that is tangent to the heading has curvature 2 y / d^2.
    const double curvature_per_m = 2.0 * aim.y / std::max(dot(aim, aim), 1e-6);
    return {cruise, std::clamp(curvature_per_m * std::max(cruise, v_now), -most_radps, most_radps)};
  }

  MotionLimits limits_;
  double tick_s_;
  TwistRamp ramp_;
  motion::MotionStatus status_;
};

}  // namespace

Vec2 look_ahead(const Path& path, Vec2 robot, double ahead_m) noexcept {
  const auto is_nearer = [robot](Vec2 a, Vec2 b) { return distance(a, robot) < distance(b, robot); };
  for (const Vec2* p = std::min_element(path.begin(), path.end(), is_nearer); p + 1 < path.end(); ++p) {
    const double piece = distance(p[0], p[1]);
    if (piece > ahead_m) return p[0] + (p[1] - p[0]) * (ahead_m / piece);
    ahead_m -= piece;
  }
  return path.back();
}

void check(const PaperConfig& config) {
  const double inflation_m = config.inflation_m, margin_m = config.mover_margin_m, cap_s = config.horizon_cap_s;
  field::check(config);
  field::refuse_unless(inflation_m >= 0.0 && inflation_m <= 5.0, "inflation_m", inflation_m, "choose 0 to 5 m");
  field::refuse_unless(margin_m >= 0.0 && margin_m <= 5.0, "mover_margin_m", margin_m, "choose 0 to 5 m");
  field::refuse_unless(cap_s > 0.0 && cap_s <= 60.0, "horizon_cap_s", cap_s, "choose up to 60 s");
}

Warping warping_for(const PaperConfig& config, const Window& window, const PlanRequest& request) noexcept {
  const Vec2 robot = window.in_cells(request.map_from_robot.position());
  const Vec2 ahead = direction(request.map_from_robot.heading);
  const auto in_cells = [&](double metres) { return static_cast<float>(metres / window.cell_m); };
  return {.robot_x = static_cast<float>(robot.x),
          .robot_y = static_cast<float>(robot.y),
          .cos_heading = static_cast<float>(ahead.x),
          .sin_heading = static_cast<float>(ahead.y),
          .cap_s = static_cast<float>(config.horizon_cap_s),
          .safety = in_cells(config.mover_margin_m),
          .most_spread = in_cells(kMostSpread_m),
          .process_noise = static_cast<float>(kProcessNoise_m2ps3 / (window.cell_m * window.cell_m))};
}

std::int32_t fetch_movers(const Window& window, std::span<const Track> tracks, Mover* movers,
                          std::array<std::uint32_t, kMaxTracks>& ids) noexcept {
  std::size_t count = 0;
  for (const Track& track : tracks) {
    const Vec2 at = track.position_in_map, v = track.velocity_in_map, p = window.in_cells(at);
    const AxisCovariance& c = track.covariance;
    if (!are_plausible({at.x, at.y, v.x, v.y, c.pp, c.pv, c.vv, track.radius_m})) continue;
    if (count == kMaxTracks) break;
    movers[count] = {.x = axis(p.x, v.x, c, window.cell_m),
                     .y = axis(p.y, v.y, c, window.cell_m),
                     .radius = static_cast<float>(track.radius_m / window.cell_m),
                     .speed = static_cast<float>(norm(v) / window.cell_m)};
    ids[count++] = track.id;
  }
  return static_cast<std::int32_t>(count);
}

void fetch_walls(const Window& window, const EvidenceMap* still, std::uint8_t* occupants) noexcept {
  if (still == nullptr) {
    std::fill_n(occupants, window.grid().cells(), std::uint8_t{0});
    return;
  }
  constexpr std::int32_t kPiece = 64;  // divides every window's side
  std::array<std::int8_t, kPiece> evidence;
  for (std::int32_t j = 0; j < window.side; ++j) {
    for (std::int32_t i = 0; i < window.side; i += kPiece) {
      still->copy_row({window.low.i + i, window.low.j + j}, kPiece, evidence.data());
      std::uint8_t* piece = occupants + window.grid().at(i, j);
      for (std::size_t k = 0; k < evidence.size(); ++k) {
        piece[k] = evidence[k] > EvidenceMap::kOccupied ? std::uint8_t{kWall} : std::uint8_t{0};
      }
    }
  }
}

void fetch_keep_out(const Window& window, const KeepOut& keep_out, Vec2 robot, std::uint8_t* occupants) noexcept {
  if (!keep_out.known()) return;
  const auto distance_at = [&keep_out](Vec2 p) {
    return static_cast<double>(keep_out.distance(static_cast<float>(p.x), static_cast<float>(p.y)));
  };
  const double deep_m = -distance_at(robot);
  const double open_m = deep_m > 0.0 ? deep_m + kWayOut_m : 0.0;
  const Vec2 first{static_cast<double>(keep_out.low_x), static_cast<double>(keep_out.low_y)};
  const double node_m = static_cast<double>(keep_out.node_m);
  const CellIndex low = window.cell_at(first),
                  high = window.cell_at(first + Vec2{keep_out.width * node_m, keep_out.height * node_m});
  for (std::int32_t j = std::max(low.j, 0); j <= std::min(high.j, window.side - 1); ++j) {
    for (std::int32_t i = std::max(low.i, 0); i <= std::min(high.i, window.side - 1); ++i) {
      const Vec2 middle = window.in_map({i + 0.5, j + 0.5});
      if (distance_at(middle) < 0.0 && distance(middle, robot) >= open_m) occupants[window.grid().at(i, j)] |= kWall;
    }
  }
}

void fetch_standing(const Window& window, std::span<const StandingPedestrian> standing,
                    std::uint8_t* occupants) noexcept {
  for (const StandingPedestrian& stander : standing) {
    const Vec2 at = stander.position_in_map;
    if (!are_plausible({at.x, at.y, stander.radius_m})) continue;
    field::for_each_in_disc(window, {0, 0, window.side - 1, window.side - 1}, at, stander.radius_m,
                            [&](std::int32_t c) { occupants[c] |= kMover; });
  }
}

std::unique_ptr<Planner> make_cpu_paper_planner(const PaperConfig& config) {
  check(config);
  return std::make_unique<PaperPlanner<SerialExecutor>>(config, std::make_unique<SerialExecutor>());
}

std::unique_ptr<motion::Motion> make_motion(const motion::MotionSetup& setup) {
  return std::make_unique<PathMotion>(setup);
}

std::unique_ptr<MapField> make_cpu_map_field(CellMap map) {
  return std::make_unique<MapFieldOn<SerialExecutor>>(std::move(map), std::make_unique<SerialExecutor>());
}

}  // namespace jaywalk::paper
