#include "cuda/emulated/shared_memory.h"

#include <link.h>

#include <algorithm>
#include <cstdint>
#include <utility>

#include "cuda/emulated/poison.h"

namespace jaywalk {
alignas(1024) thread_local unsigned char block_memory[kMostSharedBytes];
}

namespace jaywalk::emulated {
namespace {

struct ThreadLocals {
  std::byte* begin = nullptr;
  std::size_t size = 0;
};

/// Of the program's part that holds block_memory, in the calling thread.
int find(dl_phdr_info* part, std::size_t, void* into) {
  for (int k = 0; k < part->dlpi_phnum; ++k) {
    const auto& header = part->dlpi_phdr[k];
    if (header.p_type != PT_TLS || part->dlpi_tls_data == nullptr) continue;
    auto* begin = static_cast<std::byte*>(part->dlpi_tls_data);
    const auto* memory = reinterpret_cast<const std::byte*>(&block_memory[0]);
    if (memory < begin || memory >= begin + header.p_memsz) continue;
    *static_cast<ThreadLocals*>(into) = {begin, header.p_memsz};
    return 1;
  }
  return 0;
}

}  // namespace

void SharedMemory::begin(std::size_t blocks, std::size_t dynamic) {
  ThreadLocals locals;
  ::dl_iterate_phdr(find, &locals);
  live_ = locals.begin;
  before_ = static_cast<std::size_t>(reinterpret_cast<std::byte*>(&block_memory[0]) - live_);
  dynamic_ = dynamic;
  after_ = locals.size - before_ - kMostSharedBytes;
  kept_.resize(blocks);
  for (auto& kept : kept_) {
    kept.assign(live_, live_ + before_ + dynamic_);
    poison(kept.data() + before_, dynamic_);
    kept.insert(kept.end(), live_ + before_ + kMostSharedBytes, live_ + locals.size);
  }
  running_ = kOutside;
}

void SharedMemory::swap(std::size_t block) {
  std::byte* kept = kept_[block].data();
  const std::size_t used = before_ + dynamic_;
  std::swap_ranges(live_, live_ + used, kept);
  std::swap_ranges(kept + used, kept + used + after_, live_ + before_ + kMostSharedBytes);
}

void SharedMemory::enter(std::size_t block) {
  if (block == running_) return;
  if (running_ != kOutside) swap(running_);
  if (block != kOutside) swap(block);
  running_ = block;
}

void SharedMemory::end() { enter(kOutside); }

void* SharedMemory::of_block(const void* variable, std::size_t block) {
  const auto at = static_cast<std::size_t>(static_cast<const std::byte*>(variable) - live_);
  if (block == running_) return live_ + at;
  return kept_[block].data() + (at < before_ + dynamic_ ? at : at - kMostSharedBytes + dynamic_);
}

}  // namespace jaywalk::emulated
