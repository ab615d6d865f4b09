#include "cuda/emulated/fibers.h"

#include <sys/mman.h>
#include <ucontext.h>

#include <cstring>
#include <new>
#include <vector>

// A switch that saves what the calling convention asks for takes some 5 ns, one by ucontext a system call. Sanitizers
// know ucontext alone.
#if defined(__x86_64__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define JAYWALK_OWN_SWITCH 1
asm(R"(
  .text
  .p2align 4
  .globl jaywalk_switch_fiber
  .hidden jaywalk_switch_fiber
  .type jaywalk_switch_fiber, @function
jaywalk_switch_fiber:
  pushq %rbp
  pushq %rbx
  pushq %r12
  pushq %r13
  pushq %r14
  pushq %r15
  movq %rsp, (%rdi)
  movq %rsi, %rsp
  popq %r15
  popq %r14
  popq %r13
  popq %r12
  popq %rbx
  popq %rbp
  ret
  .size jaywalk_switch_fiber, .-jaywalk_switch_fiber
)");
/// Keeps what a function keeps on this stack, the stack's pointer in `*from`, and goes on where `to` was kept.
extern "C" void jaywalk_switch_fiber(void** from, void* to);
#endif

namespace jaywalk::emulated {
namespace {

constexpr std::size_t kStack = 65536;  ///< bytes; a page of it is touched as a rule
constexpr std::uint64_t kCanary = 0x6a6179776a617977;

}  // namespace

struct Fibers::Parts {
#ifdef JAYWALK_OWN_SWITCH
  using Place = void*;
#else
  using Place = ucontext_t;
#endif
  char* stacks = nullptr;
  std::size_t room = 0, count = 0;
  std::vector<Place> fibers;
  std::vector<char> ended;
  Place caller{};
  std::size_t running = 0;
  void (*entry)(void*) = nullptr;
  void* context = nullptr;
  static Parts* current;

  [[nodiscard]] char* stack(std::size_t k) const { return stacks + k * kStack; }

  [[noreturn]] static void begin() {
    Parts& parts = *current;
    parts.entry(parts.context);
    parts.ended[parts.running] = 1;
    parts.give_way();
    __builtin_unreachable();
  }
  void prepare(std::size_t k);
  void give_way();
  void go_on(std::size_t k);
};

Fibers::Parts* Fibers::Parts::current = nullptr;

#ifdef JAYWALK_OWN_SWITCH
void Fibers::Parts::prepare(std::size_t k) {
  constexpr int kSaved = 6;
  // Where begin() starts the stack is 8 bytes off a multiple of 16, as after a call.
  // Stacks begin at different places of a page: at the same they would drive one another from the nearest cache.
  auto** top = reinterpret_cast<void**>(stack(k) + kStack - 64 * (1 + k % 63));
  *--top = nullptr;
  *--top = reinterpret_cast<void*>(&begin);
  for (int saved = 0; saved < kSaved; ++saved) *--top = nullptr;
  fibers[k] = top;
}
void Fibers::Parts::give_way() { jaywalk_switch_fiber(&fibers[running], caller); }
void Fibers::Parts::go_on(std::size_t k) { jaywalk_switch_fiber(&caller, fibers[k]); }
#else
void Fibers::Parts::prepare(std::size_t k) {
  ::getcontext(&fibers[k]);
  fibers[k].uc_stack.ss_sp = stack(k);
  fibers[k].uc_stack.ss_size = kStack;
  fibers[k].uc_link = nullptr;
  ::makecontext(&fibers[k], &begin, 0);
}
void Fibers::Parts::give_way() { ::swapcontext(&fibers[running], &caller); }
void Fibers::Parts::go_on(std::size_t k) { ::swapcontext(&caller, &fibers[k]); }
#endif

Fibers::Fibers() : parts_(std::make_unique<Parts>()) {}

Fibers::~Fibers() {
  if (parts_->stacks != nullptr) ::munmap(parts_->stacks, parts_->room * kStack);
}

void Fibers::make(std::size_t n, void (*entry)(void*), void* context) {
  Parts& parts = *parts_;
  if (parts.room < n) {
    if (parts.stacks != nullptr) ::munmap(parts.stacks, parts.room * kStack);
    void* stacks =
        ::mmap(nullptr, n * kStack, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (stacks == MAP_FAILED) throw std::bad_alloc();
    parts.stacks = static_cast<char*>(stacks);
    parts.room = n;
    parts.fibers.resize(n);
    parts.ended.resize(n);
  }
  parts.count = n, parts.entry = entry, parts.context = context;
  for (std::size_t k = 0; k < n; ++k) {
    std::memcpy(parts.stack(k), &kCanary, sizeof kCanary);
    parts.ended[k] = 0;
    parts.prepare(k);
  }
}

bool Fibers::resume(std::size_t k) {
  Parts::current = parts_.get();
  parts_->running = k;
  parts_->go_on(k);
  return parts_->ended[k] == 0;
}

void Fibers::give_way() { parts_->give_way(); }

bool Fibers::are_stacks_whole() const {
  for (std::size_t k = 0; k < parts_->count; ++k) {
    if (std::memcmp(parts_->stack(k), &kCanary, sizeof kCanary) != 0) return false;
  }
  return true;
}

}  // namespace jaywalk::emulated
