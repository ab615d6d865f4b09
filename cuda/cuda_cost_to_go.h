#pragma once
#include "cuda/cuda_device.h"
#include "cuda/near_far.h"
#include "planner/cost_to_go/cost_settler.h"

namespace jaywalk {

/// The time to go on a device, over cells (`max_side` a side at most) and over poses. Thread: the planner's.
class CudaCostToGo final : public field::CostSettler {
 public:
  /// Device and limit as CudaDevice has them, and throws like it.
  CudaCostToGo(int device, std::chrono::milliseconds limit, std::int32_t max_side);
  [[nodiscard]] bool is_ready() noexcept override { return device_.is_ready(); }
  [[nodiscard]] const char* failure() const noexcept override { return device_.failure(); }
  [[nodiscard]] double took_ms() const noexcept override { return device_.took_ms(); }
  [[nodiscard]] const char* name() const noexcept override { return "cuda"; }
  [[nodiscard]] bool settle(const field::PoseCosts& poses) noexcept override;
  [[nodiscard]] bool settle(const field::CellCosts& cells) noexcept override;
  /// Of the last settlement.
  [[nodiscard]] const Piles::Told& told() const noexcept { return *told_.host; }

 private:
  /// False: the device failed, or a pile was full.
  template <class Graph, class T>
  [[nodiscard]] bool read_settled(const Graph& graph, const Shared<T>& settled, std::size_t n) noexcept;

  /// Once it has failed it is asked for nothing more until is_ready().
  [[nodiscard]] bool begins() noexcept { return !device_.has_failed() && device_.begin(); }

  CudaDevice device_;
  static constexpr std::size_t kNodes = static_cast<std::size_t>(field::PoseLook::kNodes) * field::PoseLook::kNodes;
  static constexpr std::size_t kMostPoints = 256, kLooks = PoseLattice::kHeadings * field::PoseLook::kSides;

  Shared<std::uint8_t> nodes_, radius_, rate_of_room_;
  Shared<std::int32_t> places_;
  Shared<std::uint8_t> room_;
  Shared<std::int8_t> shift_;
  Shared<std::uint8_t> pose_rate_, dearer_, unseen_;
  Shared<std::uint16_t> pose_cost_;
  std::uint32_t* wide_cost_;  ///< of poses, while they are settled
  Shared<field::BackMoves> moves_;
  Shared<field::CellNode> cells_;
  Shared<Piles::Told> told_;
  Piles piles_;
};

}  // namespace jaywalk
