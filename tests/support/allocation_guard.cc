#include "tests/support/allocation_guard.h"

#include <cerrno>
#include <cstddef>

#if defined(__has_feature)
#define JAYWALK_HAS_FEATURE(feature) __has_feature(feature)
#else
#define JAYWALK_HAS_FEATURE(feature) 0
#endif
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || JAYWALK_HAS_FEATURE(address_sanitizer) || \
    JAYWALK_HAS_FEATURE(thread_sanitizer)
#define JAYWALK_SANITIZER_HEAP 1
#else
#define JAYWALK_SANITIZER_HEAP 0
#endif

namespace {
// Counted always: a guard is a difference, so nothing has to be switched on or off.
constinit thread_local std::uint64_t calls_of_this_thread = 0;
}  // namespace

#if JAYWALK_SANITIZER_HEAP

// From <sanitizer/allocator_interface.h>, which not every compiler package brings along.
extern "C" int __sanitizer_install_malloc_and_free_hooks(void (*on_malloc)(const volatile void*, std::size_t),
                                                         void (*on_free)(const volatile void*));

namespace {
void count_malloc(const volatile void*, std::size_t) { ++calls_of_this_thread; }
void count_free(const volatile void*) { ++calls_of_this_thread; }
[[maybe_unused]] const int installed = __sanitizer_install_malloc_and_free_hooks(count_malloc, count_free);
}  // namespace

#else

extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
void __libc_free(void*);

void* malloc(std::size_t bytes) noexcept {
  ++calls_of_this_thread;
  return __libc_malloc(bytes);
}
void* calloc(std::size_t count, std::size_t bytes) noexcept {
  ++calls_of_this_thread;
  return __libc_calloc(count, bytes);
}
void* realloc(void* block, std::size_t bytes) noexcept {
  ++calls_of_this_thread;
  return __libc_realloc(block, bytes);
}
void* memalign(std::size_t alignment, std::size_t bytes) noexcept {
  ++calls_of_this_thread;
  return __libc_memalign(alignment, bytes);
}
void* aligned_alloc(std::size_t alignment, std::size_t bytes) noexcept { return memalign(alignment, bytes); }
int posix_memalign(void** block, std::size_t alignment, std::size_t bytes) noexcept {
  *block = memalign(alignment, bytes);
  return *block == nullptr ? ENOMEM : 0;
}
void free(void* block) noexcept {
  if (block == nullptr) return;
  ++calls_of_this_thread;
  __libc_free(block);
}
}

#endif

namespace jaywalk {

AllocationGuard::AllocationGuard() noexcept : calls_before_(calls_of_this_thread) {}

std::uint64_t AllocationGuard::calls() const noexcept { return calls_of_this_thread - calls_before_; }

}  // namespace jaywalk
