#pragma once
#include "cuda/cuda_device.h"
#include "planner/cost_to_go/cost_settler.h"

namespace jaywalk {

/// The time to go on a device: over the cells of windows of up to `max_side` cells, and over poses. Thread: the
/// planner's.
class CudaCostToGo final : public field::CostSettler {
 public:
  /// Device and limit as CudaDevice has them, and throws like it.
  CudaCostToGo(int device, std::chrono::milliseconds limit, std::int32_t max_side);
  [[nodiscard]] bool is_ready() noexcept override { return device_.is_ready(); }
  [[nodiscard]] bool has_failed() const noexcept override { return device_.has_failed(); }
  [[nodiscard]] const char* failure() const noexcept override { return device_.failure(); }
  [[nodiscard]] double took_ms() const noexcept override { return device_.took_ms(); }
  [[nodiscard]] const char* name() const noexcept override { return "cuda"; }
  [[nodiscard]] bool settle(const field::PoseCosts& poses) noexcept override;
  [[nodiscard]] bool settle(const field::CellCosts& cells) noexcept override;
  [[nodiscard]] bool find(const field::PoseLook& look) noexcept override;

 private:
  template <class Ways>
  [[nodiscard]] bool read_settled(const Ways& ways, const Shared<typename Ways::Value>& cost, std::size_t n) noexcept;

  /// Once it has failed it is asked for nothing more until is_ready().
  [[nodiscard]] bool begins() noexcept { return !device_.has_failed() && device_.begin(); }

  CudaDevice device_;
  static constexpr std::size_t kNodes = static_cast<std::size_t>(field::PoseLook::kNodes) * field::PoseLook::kNodes;
  static constexpr std::size_t kMostPoints = 256, kLooks = PoseLattice::kHeadings * field::PoseLook::kSides;

  Shared<std::uint8_t> nodes_, radius_;
  Shared<std::int32_t> places_;
  Shared<std::uint8_t> room_;
  Shared<std::int8_t> shift_;
  Shared<std::uint8_t> pose_rate_, unseen_;
  Shared<std::uint16_t> pose_cost_;
  Shared<PoseMove> moves_;
  Shared<std::int32_t> move_count_;
  Shared<std::uint32_t> cells_;
  Shared<std::int32_t> waits_;
};

}  // namespace jaywalk
