#include "planner/motion/local_ground.h"

namespace jaywalk::motion {
namespace {

constexpr std::int32_t kSide = 112;  ///< cells of 0.1 m: 4.8 m at least to each side of a robot in the middle block
constexpr std::int32_t kBlock = 16;  ///< the window moves by so many cells, so that most looks find the last one's
constexpr double kCell_m = 0.1;
constexpr std::size_t kCells = static_cast<std::size_t>(kSide) * kSide;

std::int32_t block_below(std::int32_t cell) { return (cell >= 0 ? cell : cell - kBlock + 1) / kBlock * kBlock; }

}  // namespace

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
