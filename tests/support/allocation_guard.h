#pragma once
#include <cstdint>

namespace jaywalk {

/// Counts what this thread asks of the heap while the guard lives: malloc, calloc, realloc, free, the
/// aligned ones, and with them every operator new and delete. Read `calls` into a variable before checking
/// it: the check macros allocate themselves.
///
///   const AllocationGuard guard;
///   for (int k = 0; k < 1000; ++k) loop.tick(now += kPeriod);
///   const auto calls = guard.calls();
///   CHECK(calls == 0);
///
/// In a plain build this library's malloc family stands before glibc's; under the address and thread sanitizers, which
/// bring their own heap, their hooks count.
/// Thread: guards count the thread that reads them; they nest.
class AllocationGuard {
 public:
  AllocationGuard() noexcept;
  /// Calls by this thread since the guard was made; free(nullptr) is none.
  [[nodiscard]] std::uint64_t calls() const noexcept;

 private:
  std::uint64_t calls_before_;
};

}  // namespace jaywalk
