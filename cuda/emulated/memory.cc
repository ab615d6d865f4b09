#include "cuda/emulated/memory.h"

#include <sys/mman.h>

#include <cassert>
#include <cstring>

namespace jaywalk::emulated {
namespace {

constexpr std::size_t kPage = 4096, kAlignment = 256;  // of cudaMalloc (CUDA C++ Programming Guide, 5.3.2)

std::size_t rounded_up(std::size_t bytes, std::size_t to) { return (bytes + to - 1) / to * to; }

}  // namespace

void Memory::begin_anew(std::size_t room, std::uint8_t poison, bool guarded) {
  while (!blocks_.empty()) release(blocks_.begin()->first);
  room_ = room, poison_ = poison, guarded_ = guarded, works_ = false;
}

void* Memory::take(std::size_t bytes, Where where) {
  if (bytes > room_) return nullptr;
  const std::size_t used = rounded_up(bytes, kPage);
  void* const pages = ::mmap(nullptr, used + kPage, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (pages == MAP_FAILED) return nullptr;
  std::memset(pages, poison_, used);
  const Block block{static_cast<char*>(pages), bytes, used, where};
  ::mprotect(block.pages + used, kPage, PROT_NONE);
  protect(block);
  room_ -= bytes;
  return blocks_.emplace(block.pages + used - rounded_up(bytes, kAlignment), block).first->first;
}

void Memory::release(void* block) {
  if (block == nullptr) return;
  const auto at = blocks_.find(block);
  assert(at != blocks_.end());
  room_ += at->second.bytes;
  ::munmap(at->second.pages, at->second.used + kPage);
  blocks_.erase(at);
}

void Memory::protect(bool works) {
  if (works == works_) return;
  works_ = works;
  for (const auto& [begin, block] : blocks_) protect(block);
}

void Memory::protect(const Block& block) const {
  if (!guarded_ || block.where == Where::kPinned) return;
  ::mprotect(block.pages, block.used, works_ ? PROT_READ | PROT_WRITE : PROT_NONE);
}

}  // namespace jaywalk::emulated
