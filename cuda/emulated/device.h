#pragma once
// An emulated CUDA device on one thread of the CPU. Kernels are the project's own, compiled by the host's compiler;
// what is launched runs when something waits for it, so that a wait that is missing shows. cuda/README.md.
#include <cstdint>
#include <deque>
#include <map>
#include <mutex>

#include "cuda/emulated/block.h"
#include "cuda/emulated/include/cuda_runtime.h"

namespace jaywalk::emulated {

enum class Where : std::uint8_t {
  kDevice,  ///< the device's alone
  kPinned,  ///< of the host; the device's too
};

/// Each allocation is poisoned and ends at a page that nothing may touch. Where memory is guarded, which takes longer
/// than small kernels do, the host's access to what is not its own is a segmentation fault.
class Memory {
 public:
  /// Releases all memory. From now on there are `room` bytes; a block that is taken is filled with `poison`.
  void begin_anew(std::size_t room, std::uint8_t poison, bool guarded);
  /// Leaves no room for further blocks.
  void fill() { room_ = 0; }
  /// Null where there is no room.
  [[nodiscard]] void* take(std::size_t bytes, Where where);
  /// `block`: what take() returned, or null.
  void release(void* block);
  /// `works`: the device does, and the host waits.
  void protect(bool works);

 private:
  struct Block {
    char* pages;
    std::size_t bytes, used;  ///< asked for; in pages, without the last
    Where where;
  };
  void protect(const Block& block) const;

  std::map<void*, Block> blocks_;
  std::size_t room_ = 0;
  std::uint8_t poison_ = 0;
  bool guarded_ = false;
  bool works_ = false;
};

struct Properties {
  int devices = 1;       ///< all alike; 0: none is there
  bool guarded = false;  ///< the host cannot touch what is not its own (Memory)
  std::size_t bytes = std::size_t{4} << 30;
  int not_ready = 0;       ///< queries of an event that answer "not ready" before its work runs
  std::uint64_t seed = 1;  ///< of the order in which threads run
};

/// How a launch can be ordered to fail.
enum class Fault : std::uint8_t {
  kNone,
  kRefused,  ///< the launch is refused; the next one runs
  kBroken,   ///< the launch fails, and every later call returns its error
  kHangs,    ///< it never ends
};

/// Launches that have run, barriers of their blocks that have opened, and waits for an event that were over.
struct Counts {
  std::int64_t launches = 0, block = 0, waits = 0;
};

/// All streams share one queue: work runs in the order of the calls.
struct Device {
  Device() { power_on(); }
  /// Ends the program where a kernel never ends: a driver would wait for it for ever.
  ~Device();
  /// Resets the device: nothing is launched, no memory taken, no fault ordered.
  void power_on(const Properties& of = {});
  /// Makes a launch fail: the next one, or the one after `after_launches` more.
  void order(Fault of_launch, int after_launches = 0) { fault = of_launch, fault_after = after_launches; }
  /// From now on so many queries of an event answer "not ready".
  void delay(int times) { properties.not_ready = not_ready = times; }

  std::mutex mutex;  ///< of all calls
  Properties properties;
  Memory memory;
  Counts counts;
  OrderRandom random;
  std::deque<std::function<void()>> line;
  std::uint64_t put = 0;  ///< calls queued so far
  bool is_stuck = false;  ///< the first in the queue is a kernel that never ends
  int not_ready = 0;      ///< such queries that are left
  cudaError_t sticky = cudaSuccess, last = cudaSuccess;
  Fault fault = Fault::kNone;
  int fault_after = 0;
};

/// The program's only device.
inline Device& device() {
  static Device only;
  return only;
}

}  // namespace jaywalk::emulated
