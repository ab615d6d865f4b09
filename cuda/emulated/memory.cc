#include "cuda/emulated/memory.h"

#include <sys/mman.h>

#include "cuda/emulated/poison.h"

namespace jaywalk::emulated {
namespace {

constexpr std::size_t kPage = 4096, kAlignment = 256;  // of cudaMalloc (CUDA C++ Programming Guide, 5.3.2)

std::size_t rounded_up(std::size_t bytes, std::size_t to) { return (bytes + to - 1) / to * to; }

}  // namespace

Memory::~Memory() {
  begin_anew(false);
  for (const auto& [size, pages] : spare_) ::munmap(pages, size);
}

void* Memory::take(std::size_t bytes, Where where, std::size_t most) {
  if (bytes > most || taken_ > most - bytes) return nullptr;
  const std::size_t used = rounded_up(bytes, kPage), size = used + kPage;
  char* pages = nullptr;
  if (const auto spare = spare_.find(size); spare != spare_.end()) {
    pages = spare->second;
    spare_.erase(spare);
  } else {
    void* fresh = ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (fresh == MAP_FAILED) return nullptr;
    pages = static_cast<char*>(fresh);
    ::mprotect(pages + used, kPage, PROT_NONE);
  }
  poison(pages, used);
  char* begin = pages + (used - rounded_up(bytes, kAlignment));
  const auto [at, is_new] = blocks_.emplace(begin, Block{pages, bytes, used, size, where});
  taken_ += bytes;
  if (!is_open(at->second)) protect(at->second, false);
  return begin;
}

bool Memory::release(void* block) {
  if (block == nullptr) return true;
  const auto at = blocks_.find(block);
  if (at == blocks_.end()) return false;
  taken_ -= at->second.bytes;
  if (guarded_) protect(at->second, true);
  spare_.emplace(at->second.size, at->second.pages);
  blocks_.erase(at);
  return true;
}

void Memory::begin_anew(bool guarded) {
  while (!blocks_.empty()) release(blocks_.begin()->first);
  guarded_ = guarded;
}

bool Memory::is_open(const Block& block) const {
  return !guarded_ || works_ || block.where == Where::kPinned || (block.where == Where::kManaged && !busy_);
}

void Memory::protect(const Block& block, bool open) {
  ::mprotect(block.pages, block.used, open ? PROT_READ | PROT_WRITE : PROT_NONE);
}
void Memory::protect_all() {
  if (!guarded_) return;
  for (const auto& [begin, block] : blocks_) {
    if (block.where != Where::kPinned) protect(block, is_open(block));
  }
}

void Memory::begin_work() {
  works_ = true;
  protect_all();
}
void Memory::end_work() {
  works_ = false;
  protect_all();
}
void Memory::open(const void* in_block, bool open) {
  auto after = blocks_.upper_bound(const_cast<void*>(in_block));
  if (after == blocks_.begin()) return;
  const Block& block = (--after)->second;
  if (in_block < block.pages + block.used && !is_open(block)) protect(block, open);
}
void Memory::set_busy(bool busy) {
  if (busy == busy_) return;
  busy_ = busy;
  if (!guarded_) return;
  for (const auto& [begin, block] : blocks_) {
    if (block.where == Where::kManaged) protect(block, is_open(block));
  }
}

}  // namespace jaywalk::emulated
