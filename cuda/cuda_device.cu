#include <sys/prctl.h>

#include <cstring>
#include <stdexcept>
#include <thread>

#include "cuda/cuda_device.h"

namespace jaywalk {
namespace {

/// The host looks without a break, and then sleeps between two looks, so that no core is kept busy.
constexpr std::chrono::microseconds kSpin{100}, kLook{20};
constexpr unsigned long kSlack_ns = 1000;  ///< of these sleeps: 50,000 by default, more than all of the wait
/// A host that was kept from its processor for a while looks so often before it gives the device up.
constexpr int kFewestLooks = 10;

void must(cudaError_t error) {
  if (error != cudaSuccess) throw std::runtime_error(cudaGetErrorString(error));
}

}  // namespace

CudaDevice::CudaDevice(int device, std::chrono::milliseconds limit) : device_(device), limit_(limit) {
  int least = 0, greatest = 0;
  must(cudaSetDevice(device));
  must(cudaDeviceGetStreamPriorityRange(&least, &greatest));
  must(cudaStreamCreateWithPriority(&stream_, cudaStreamNonBlocking, greatest));
  must(cudaEventCreate(&begin_)), must(cudaEventCreate(&end_));
}

CudaDevice::~CudaDevice() {
  if (failure_ == DeviceFailure::kSilent) (void)is_back();
  if (left_behind_) return;
  for (void* block : taken_) cudaFree(block);
  for (void* block : pinned_) cudaFreeHost(block);
  cudaEventDestroy(begin_), cudaEventDestroy(end_);
  cudaStreamDestroy(stream_);
}

void* CudaDevice::take_bytes(std::size_t bytes) {
  void* block = nullptr;
  must(cudaMalloc(&block, bytes));
  taken_.push_back(block);
  must(cudaMemsetAsync(block, 0, bytes, stream_));
  must(cudaStreamSynchronize(stream_));
  return block;
}

void* CudaDevice::pin_bytes(std::size_t bytes) {
  void* block = nullptr;
  must(cudaHostAlloc(&block, bytes, cudaHostAllocPortable));
  pinned_.push_back(block);
  std::memset(block, 0, bytes);
  return block;
}

bool CudaDevice::begin() noexcept {
  if (!is_ready()) return false;
  launched_ = cudaSetDevice(device_);  // each thread of the host has its own, at first device 0
  if (launched_ == cudaSuccess) launched_ = cudaEventRecord(begin_, stream_);
  return true;
}

bool CudaDevice::wait() noexcept {
  if (has_failed()) return false;
  // Where the end cannot be marked, an earlier mark would be taken for it.
  const bool is_marked = cudaEventRecord(end_, stream_) == cudaSuccess;
  // What was launched before a refusal still runs: it is waited for as well.
  failure_ = is_marked ? waited() : DeviceFailure::kBroken;
  if (!has_failed() && launched_ != cudaSuccess) failure_ = DeviceFailure::kRefused;
  // Of errors that stay the second look still has one.
  if (cudaGetLastError() != cudaSuccess && cudaGetLastError() != cudaSuccess) failure_ = DeviceFailure::kBroken;
  float took_ms = 0.0F;
  if (!has_failed() && cudaEventElapsedTime(&took_ms, begin_, end_) == cudaSuccess)
    took_ms_ += static_cast<double>(took_ms);
  if (has_failed()) launched_ = cudaErrorLaunchFailure;
  return !has_failed();
}

DeviceFailure CudaDevice::waited() noexcept {
  const auto begin = std::chrono::steady_clock::now(), end = begin + limit_;
  (void)prctl(PR_SET_TIMERSLACK, kSlack_ns);
  for (int looks = 1;; ++looks) {
    const cudaError_t state = cudaEventQuery(end_);
    if (state == cudaSuccess) return DeviceFailure::kNone;
    if (state != cudaErrorNotReady) return DeviceFailure::kBroken;
    (void)cudaGetLastError();  // "not ready" is remembered as an error
    const auto now = std::chrono::steady_clock::now();
    if (looks > kFewestLooks && now > end) return left_behind_ = true, DeviceFailure::kSilent;
    if (now - begin > kSpin) std::this_thread::sleep_for(kLook);
  }
}

/// Whether what was silent has ended after all.
bool CudaDevice::is_back() noexcept {
  const bool back = cudaEventQuery(end_) == cudaSuccess;
  (void)cudaGetLastError();
  if (back) left_behind_ = false;
  return back;
}

const char* CudaDevice::failure() const noexcept {
  switch (failure_) {
    case DeviceFailure::kNone: return "";
    case DeviceFailure::kRefused: return "a launch was refused";
    case DeviceFailure::kBroken: return "the device failed";
    case DeviceFailure::kSilent: return "a kernel did not end in time";
  }
  return "";
}

}  // namespace jaywalk
