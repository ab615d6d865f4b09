// longjmp() from stack to stack is what fibers are about, and what its fortified version takes for a mistake.
#undef _FORTIFY_SOURCE
#include "cuda/emulated/block.h"

#include <setjmp.h>
#include <sys/mman.h>
#include <ucontext.h>

#include <algorithm>
#include <cassert>
#include <cstdio>
#include <numeric>

namespace jaywalk::emulated {
namespace {

constexpr std::size_t kGuard = 4096, kStack = 16 * kGuard;  // a page of it is touched as a rule

/// Runs threads one after the other until one of them waits: those of a kernel without barriers all run in one fiber.
struct Fiber {
  jmp_buf place;    ///< where the fiber goes on
  unsigned thread;  ///< the thread that waits in it
};

/// Fibers stay from block to block: to make one takes as long as a hundred switches.
Fiber fibers[kMostThreads];
std::size_t made = 0, running = 0;
jmp_buf caller;

const std::function<void()>* running_kernel = nullptr;
std::vector<unsigned> order;       ///< of threads to begin; at barriers, of fibers to go on
std::size_t begun = 0, ended = 0;  ///< threads

void give_way() {
  if (_setjmp(fibers[running].place) == 0) _longjmp(caller, 1);
}

[[noreturn]] void run_threads() {
  for (;; give_way()) {
    while (begun < order.size()) {
      threadIdx.x = order[begun++];
      (*running_kernel)();
      ++ended;
    }
  }
}

void make_and_enter(std::size_t fiber) {
  static void* const stacks = ::mmap(nullptr, kMostThreads * kStack, PROT_READ | PROT_WRITE,
                                     MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  assert(stacks != MAP_FAILED);
  char* const stack = static_cast<char*>(stacks) + fiber * kStack;
  ::mprotect(stack, kGuard, PROT_NONE);  // a stack that is too small ends the program
  ucontext_t context;
  ::getcontext(&context);
  context.uc_stack.ss_sp = stack;
  // Stacks begin at different places of a page: at the same place they would evict one another from the first cache.
  context.uc_stack.ss_size = kStack - 64 * (fiber % 63);
  ::makecontext(&context, &run_threads, 0);
  made = fiber + 1;
  ::setcontext(&context);
}

/// Runs a fiber until its thread waits, or no thread is left for it.
void run_fiber(std::size_t fiber) {
  running = fiber;
  if (_setjmp(caller) != 0) return;
  if (fiber < made) _longjmp(fibers[fiber].place, 1);
  make_and_enter(fiber);
}

void open_barrier(OrderRandom& random) {
  std::shuffle(order.begin(), order.end(), random);
  for (const unsigned fiber : order) {
    threadIdx.x = fibers[fiber].thread;
    run_fiber(fiber);
  }
}

}  // namespace

std::vector<unsigned> in_random_order(std::size_t n, OrderRandom& random) {
  std::vector<unsigned> order(n);
  std::iota(order.begin(), order.end(), 0U);
  std::shuffle(order.begin(), order.end(), random);
  return order;
}

bool run_block(std::size_t threads, const std::function<void()>& kernel, OrderRandom& random, std::int64_t& barriers) {
  assert(threads > 0 && threads <= kMostThreads);
  running_kernel = &kernel;
  order = in_random_order(threads, random);
  begun = ended = 0;
  for (std::size_t fiber = 0; begun < threads; ++fiber) run_fiber(fiber);
  for (; ended == 0; ++barriers) open_barrier(random);
  if (ended == threads) return true;
  std::fprintf(stderr, "emulated CUDA: of %zu threads %zu have ended, the others wait\n", threads, ended);
  made = 0;  // fibers are left in the midst of the kernel
  return false;
}

void meet_block() {
  fibers[running].thread = threadIdx.x;
  give_way();
}

}  // namespace jaywalk::emulated
