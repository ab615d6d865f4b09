#include "planner/motion/near_returns.h"

#include <algorithm>
#include <cmath>

namespace jaywalk::motion {
namespace {

using Rules = StopZoneRules<float>;
constexpr float kEdgeM = 0.01F;  ///< a range's noise
constexpr float kNearerM =
    2e-4F;  ///< less is no approach: StopZone's, and single precision a kilometre from the origin

bool is_of_a_mover(Vec2 place, std::span<const MoverDisc> movers) {
  return std::any_of(movers.begin(), movers.end(),
                     [&](const MoverDisc& m) { return distance(place, m.centre_in_map) < m.radius_m + kOwnBody_m; });
}

/// The gap from the body at `robot` to a place in the map.
float gap_to(const RobotState& robot, const cell::Heading& along, const RobotBody& body, float x, float y) {
  const float dx = x - robot.x, dy = y - robot.y;
  return body.gap(dx * along.x + dy * along.y, dy * along.x - dx * along.y);
}

constexpr std::int32_t kSide = 112;  ///< cells of 0.1 m: 4.8 m at least to each side of a robot in the middle block
constexpr std::int32_t kBlock = 16;  ///< the window moves by so many cells, so that most looks find the last one's
constexpr double kCell_m = 0.1;
constexpr std::size_t kCells = static_cast<std::size_t>(kSide) * kSide;

std::int32_t block_below(std::int32_t cell) { return (cell >= 0 ? cell : cell - kBlock + 1) / kBlock * kBlock; }

}  // namespace

void NearReturns::update(const OfEach<SeenFrom>& scans, const RobotState& robot, const RobotBody& body,
                         std::span<const MoverDisc> movers, std::span<const Vec2> unseen_walls) noexcept {
  const float reach_m = Rules::kMargin_m + kForS * (body.bounds.speed + body.bounds.turn * body.rim_m);
  const cell::Heading along = cell::heading_at(robot.heading);
  float nearest[kSectors];
  std::fill(nearest, nearest + kSectors, reach_m + body.rim_m);
  Vec2 hit[kSectors];
  const auto take = [&](Vec2 p) {
    const float dx = static_cast<float>(p.x) - robot.x, dy = static_cast<float>(p.y) - robot.y;
    const float away = std::sqrt(dx * dx + dy * dy);
    const float turns = 0.5F + cell::angle_of(dx, dy) / (2.0F * cell::kPiF);
    const auto sector = std::min(static_cast<std::size_t>(turns * static_cast<float>(kSectors)), kSectors - 1);
    if (away < nearest[sector] && !is_of_a_mover(p, movers)) nearest[sector] = away, hit[sector] = p;
  };
  for (const SeenFrom& seen : scans) {
    const LaserScan& scan = *seen.scan;
    const Transform2 map_from(seen.map_from_laser);
    for (std::size_t beam = 0; beam < scan.beam_count; ++beam) {
      if (!scan.is_hit(beam) || scan.range_m[beam] > 2.0F * (reach_m + body.rim_m)) continue;
      take(map_from * (direction(scan.angle_rad(beam)) * static_cast<double>(scan.range_m[beam])));
    }
  }
  for (const Vec2 p : unseen_walls) take(p);
  count_ = 0, nearest_ = Rules::kBeside_m;
  for (std::size_t k = 0; k < kSectors; ++k) {
    if (nearest[k] >= reach_m + body.rim_m) continue;
    x_[count_] = static_cast<float>(hit[k].x), y_[count_] = static_cast<float>(hit[k].y);
    gap_[count_] = gap_to(robot, along, body, x_[count_], y_[count_]) - kNearerM;
    nearest_ = std::min(nearest_, gap_[count_]);
    ++count_;
  }
}

float NearReturns::braked_share(const RobotState& robot, const RobotBody& body) const noexcept {
  const cell::Heading along = cell::heading_at(robot.heading);
  float gaps[kSectors];  // a loop of its own: compilers take four at once
  for (std::size_t k = 0; k < count_; ++k) gaps[k] = gap_to(robot, along, body, x_[k], y_[k]);
  float least = Rules::kMargin_m + kEdgeM;
  for (std::size_t k = 0; k < count_; ++k) least = gaps[k] < gap_[k] && gaps[k] < least ? gaps[k] : least;
  if (least >= Rules::kMargin_m + kEdgeM) return 0.0F;
  const float rim = body.rim_mps(robot),
              creep = is_beside() && least > nearest_ - Rules::kSwing_m ? Rules::kCreep_mps : 0.0F,
              may = std::max(Rules::permitted_rim(least - kEdgeM), creep);
  return rim > may ? 1.0F - may / rim : 0.0F;
}

LocalGround::LocalGround(const KeepOut& keep_out)
    : keep_out_(keep_out),
      surfaces_(kSide),
      found_unseen_(kCells),
      unseen_(kCells),
      to_go_s_(kCells, Guide::kNoWay_s) {}

const Guide& LocalGround::update(const EvidenceMap& still, Vec2 robot, std::span<const MoverDisc> movers) noexcept {
  const CellIndex at = still.cell_at(robot);
  constexpr std::int32_t kBefore = (kSide - kBlock) / 2;
  const field::Window window{{block_below(at.i) - kBefore, block_below(at.j) - kBefore}, kSide, kCell_m};
  surfaces_.find(window, {0, 0, kSide - 1, kSide - 1}, &still, movers, found_unseen_.data());
  const Place at_m = field::place_of(robot);
  const bool is_in_one = keep_out_.distance(at_m.x, at_m.y) < 0.0F;  // then none counts: it may leave
  const Place low = field::place_of(window.in_map({0.0, 0.0}));
  guide_ = {low.x,          low.y,           static_cast<float>(kCell_m),      kSide, false, surfaces_.surface(),
            unseen_.data(), to_go_s_.data(), is_in_one ? KeepOut{} : keep_out_};
  return guide_;
}

}  // namespace jaywalk::motion
