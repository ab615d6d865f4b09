#pragma once
// Fibers: functions that give way to one another on one thread of the CPU, each with a stack of its own.
#include <cstddef>
#include <cstdint>
#include <memory>

namespace jaywalk::emulated {

/// As many fibers as a launch has threads; their memory is kept from launch to launch.
class Fibers {
 public:
  Fibers();
  ~Fibers();
  Fibers(const Fibers&) = delete;
  Fibers& operator=(const Fibers&) = delete;

  /// Makes fibers 0 to n - 1, each to call `entry(context)` once. What older ones were about is forgotten.
  void make(std::size_t n, void (*entry)(void*), void* context);
  /// Lets fiber k go on until it gives way or its entry returns. False: it has returned.
  bool resume(std::size_t k);
  /// From inside a fiber: back to the caller of resume().
  void give_way();
  /// Whether no fiber of the last make() has used more stack than there is.
  [[nodiscard]] bool are_stacks_whole() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace jaywalk::emulated
