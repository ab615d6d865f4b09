#include "cuda/emulated/device.h"

#include <sys/mman.h>

#include <cassert>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <utility>

struct CUstream_st {
  int of_device;
};
struct CUevent_st {
  std::uint64_t place;  ///< in line: before it is all that the event waits for
};

namespace jaywalk::emulated {
namespace {

constexpr std::size_t kPage = 4096, kAlignment = 256;  // of cudaMalloc (CUDA C++ Programming Guide, 5.3.2)

std::size_t rounded_up(std::size_t bytes, std::size_t to) { return (bytes + to - 1) / to * to; }

Device& d = device();
/// All that were ever made: what is left behind on a device that hangs is no leak.
std::deque<CUstream_st> streams;
std::deque<CUevent_st> events;
/// That the calling thread works on, as cudaSetDevice() has it.
thread_local int current_device = 0;

[[noreturn]] void never_returns(const char* call) {
  std::fprintf(stderr, "emulated CUDA: %s waits for a kernel that never ends\n", call);
  std::abort();
}

/// One call: alone, and with the sticky error as its answer where there is one. An error is remembered.
template <class Call>
cudaError_t call(const Call& what) {
  const std::lock_guard lock(d.mutex);
  cudaError_t error = d.sticky == cudaSuccess ? what() : d.sticky;
  if (d.sticky != cudaSuccess) error = d.sticky;
  return error == cudaSuccess ? error : d.last = error;
}

/// What a call answers that always does.
cudaError_t done() {
  return call([] { return cudaSuccess; });
}

/// What comes of a launch.
Fault next_fault() {
  return d.fault != Fault::kNone && d.fault_after-- == 0 ? std::exchange(d.fault, Fault::kNone) : Fault::kNone;
}

void run_grid(unsigned blocks, unsigned threads, const std::function<void()>& kernel) {
  blockDim.x = threads;
  for (const unsigned block : in_random_order(blocks, d.random)) {
    blockIdx.x = block;
    if (!run_block(threads, kernel, d.random, d.counts.block)) return void(d.is_stuck = true);
  }
  ++d.counts.launches;
}

/// Whether all before that place in line has run.
bool has_run(std::uint64_t place) { return d.put - d.line.size() >= place; }

/// Runs it. False: it never ends.
bool run_to(std::uint64_t place) {
  d.memory.protect(true);
  while (!has_run(place) && !d.is_stuck) {
    d.line.front()();
    if (!d.is_stuck) d.line.pop_front();
    if (d.sticky != cudaSuccess) d.line.clear();
  }
  d.memory.protect(false);
  return !d.is_stuck;
}

cudaError_t wait(std::uint64_t place, const char* in_call) {
  if (!run_to(place)) never_returns(in_call);
  return cudaSuccess;
}

cudaError_t put_in_line(std::function<void()> work) {
  d.line.push_back(std::move(work));
  ++d.put;
  return cudaSuccess;
}

cudaError_t take(void** block, std::size_t bytes, Where where) {
  return call([&] { return (*block = d.memory.take(bytes, where)) ? cudaSuccess : cudaErrorMemoryAllocation; });
}

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

void Device::power_on(const Properties& of) {
  const std::lock_guard lock(mutex);
  properties = of;
  memory.begin_anew(of.bytes, of.seed % 2 == 0 ? 0xff : 0xcd, of.guarded);  // NaNs; floats of -4e8
  random.seed(static_cast<unsigned>(of.seed));
  line.clear();
  counts = {}, is_stuck = false, sticky = last = cudaSuccess, fault = Fault::kNone, current_device = 0;
}

Device::~Device() {
  if (is_stuck) never_returns("the driver's part of exit()");
}

cudaError_t launch(const cudaLaunchConfig_t& config, std::function<void()> kernel) {
  return call([&] {
    const unsigned blocks = config.gridDim.x, threads = config.blockDim.x;
    if (config.stream->of_device != current_device) return cudaErrorInvalidResourceHandle;
    const Fault fault = next_fault();
    if (fault == Fault::kRefused) return cudaErrorLaunchOutOfResources;
    return put_in_line([=, kernel = std::move(kernel)] {
      if (fault == Fault::kHangs) return void(d.is_stuck = true);
      run_grid(blocks, threads, kernel);
      if (fault == Fault::kBroken) d.sticky = cudaErrorIllegalAddress;
    });
  });
}

}  // namespace jaywalk::emulated

using namespace jaywalk::emulated;

const char* cudaGetErrorString(cudaError_t error) {
  if (error == cudaErrorMemoryAllocation) return "out of memory";
  return error == cudaErrorNoDevice ? "no CUDA-capable device is detected" : "an error of the emulated device";
}
cudaError_t cudaGetLastError() {
  const std::lock_guard lock(d.mutex);
  return std::exchange(d.last, d.sticky);
}

cudaError_t cudaGetDeviceCount(int* count) {
  return call([&] { return (*count = d.properties.devices) > 0 ? cudaSuccess : cudaErrorNoDevice; });
}
cudaError_t cudaSetDevice(int number) {
  if (number < 0 || number >= d.properties.devices) return call([] { return cudaErrorInvalidDevice; });
  return call([&] { return current_device = number, cudaSuccess; });
}
cudaError_t cudaDeviceGetStreamPriorityRange(int* least, int* greatest) { return *least = 0, *greatest = -5, done(); }

cudaError_t cudaStreamCreateWithPriority(cudaStream_t* stream, unsigned, int) {
  return *stream = &streams.emplace_back(CUstream_st{current_device}), done();
}
cudaError_t cudaStreamDestroy(cudaStream_t) { return done(); }
cudaError_t cudaStreamSynchronize(cudaStream_t) {
  return call([] { return wait(d.put, "cudaStreamSynchronize"); });
}

cudaError_t cudaEventCreate(cudaEvent_t* event) { return *event = &events.emplace_back(), done(); }
cudaError_t cudaEventDestroy(cudaEvent_t) { return done(); }
cudaError_t cudaEventRecord(cudaEvent_t event, cudaStream_t) {
  return call([&] { return event->place = d.put, d.not_ready = d.properties.not_ready, cudaSuccess; });
}
cudaError_t cudaEventQuery(cudaEvent_t event) {
  return call([&] {
    if (!has_run(event->place) && d.not_ready > 0) return --d.not_ready, cudaErrorNotReady;
    if (!has_run(event->place) && !run_to(event->place)) return cudaErrorNotReady;
    return ++d.counts.waits, cudaSuccess;
  });
}
cudaError_t cudaEventSynchronize(cudaEvent_t event) {
  return call([&] { return wait(event->place, "cudaEventSynchronize"); });
}
cudaError_t cudaEventElapsedTime(float* ms, cudaEvent_t, cudaEvent_t) { return *ms = 0.0F, done(); }

cudaError_t cudaMalloc(void** block, std::size_t bytes) { return take(block, bytes, Where::kDevice); }
cudaError_t cudaHostAlloc(void** block, std::size_t bytes, unsigned) { return take(block, bytes, Where::kPinned); }
cudaError_t cudaFree(void* block) {
  return call([&] { return wait(d.put, "cudaFree"), d.memory.release(block), cudaSuccess; });
}
cudaError_t cudaFreeHost(void* block) { return cudaFree(block); }

cudaError_t cudaMemsetAsync(void* to, int value, std::size_t bytes, cudaStream_t) {
  return call([&] { return put_in_line([=] { std::memset(to, value, bytes); }); });
}
cudaError_t cudaMemcpyAsync(void* to, const void* from, std::size_t bytes, cudaMemcpyKind, cudaStream_t) {
  return call([&] { return put_in_line([=] { std::memcpy(to, from, bytes); }); });
}
