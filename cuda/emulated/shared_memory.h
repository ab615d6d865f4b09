#pragma once
// Shared memory of blocks. In kernels a __shared__ variable is thread_local here, so it lies in one piece of this
// thread's memory; what a block left there is put by while another block runs.
#include <cstddef>
#include <vector>

namespace jaywalk {
/// Most that a block may have on compute capability 9.0 (CUDA C++ Programming Guide, technical specifications).
inline constexpr std::size_t kMostSharedBytes = 227 * 1024;
/// What a launch asked for: a kernel declares `extern __shared__ unsigned char block_memory[];`, in this namespace.
extern thread_local unsigned char block_memory[];
}  // namespace jaywalk

namespace jaywalk::emulated {

class SharedMemory {
 public:
  /// Of this many blocks, `dynamic` bytes of block_memory each; these are poisoned. The caller's thread runs them.
  void begin(std::size_t blocks, std::size_t dynamic);
  /// Puts the running block's by and takes up another's.
  void enter(std::size_t block);
  /// As it was before begin().
  void end();

  /// Where a variable of the running block lies in another's memory, valid while the caller's block runs.
  [[nodiscard]] void* of_block(const void* variable, std::size_t block);
  [[nodiscard]] bool is_large() const { return dynamic_ > 4096; }

 private:
  static constexpr std::size_t kOutside = static_cast<std::size_t>(-1);

  void swap(std::size_t block);

  std::byte* live_ = nullptr;                         ///< all thread_local variables of this program, in this thread
  std::size_t before_ = 0, dynamic_ = 0, after_ = 0;  ///< bytes before block_memory, used of it, and after it
  std::vector<std::vector<std::byte>> kept_;
  std::size_t running_ = kOutside;
};

}  // namespace jaywalk::emulated
