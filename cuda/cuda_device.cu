#include <cstring>
#include <stdexcept>
#include <thread>

#include "cuda/cuda_device.h"

namespace jaywalk {
namespace {

/// Between two looks at the device: what a plan may come later, and no core is kept busy.
constexpr std::chrono::microseconds kLook{20};
/// A host that was kept from its processor for a while looks so often before it gives the device up.
constexpr int kFewestLooks = 10;

void must(cudaError_t error) {
  if (error != cudaSuccess) throw std::runtime_error(cudaGetErrorString(error));
}

}  // namespace

CudaDevice::CudaDevice(int device, std::chrono::milliseconds limit) : device_(device), limit_(limit) {
  int integrated = 0, managed = 0, least = 0, greatest = 0;
  must(cudaSetDevice(device));
  must(cudaDeviceGetAttribute(&integrated, cudaDevAttrIntegrated, device));
  must(cudaDeviceGetAttribute(&managed, cudaDevAttrManagedMemory, device));
  is_one_memory_ = integrated != 0 && managed != 0;
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
  must(is_one_memory_ ? cudaMallocManaged(&block, bytes) : cudaMalloc(&block, bytes));
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
  (void)cudaSetDevice(device_);  // each thread of the host has its own, at first device 0
  launched_ = cudaEventRecord(begin_, stream_);
  return true;
}

bool CudaDevice::wait() noexcept {
  if (has_failed()) return false;
  (void)cudaEventRecord(end_, stream_);
  // What was launched before a refusal still runs: it is waited for as well.
  failure_ = waited();
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
  const auto end = std::chrono::steady_clock::now() + limit_;
  for (int looks = 1;; ++looks) {
    const cudaError_t state = cudaEventQuery(end_);
    if (state == cudaSuccess) return DeviceFailure::kNone;
    if (state != cudaErrorNotReady) return DeviceFailure::kBroken;
    (void)cudaGetLastError();  // "not ready" is remembered as an error
    if (looks > kFewestLooks && std::chrono::steady_clock::now() > end)
      return left_behind_ = true, DeviceFailure::kSilent;
    std::this_thread::sleep_for(kLook);
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
    case DeviceFailure::kNone:
      return "";
    case DeviceFailure::kRefused:
      return "a launch was refused";
    case DeviceFailure::kBroken:
      return "the device failed";
    case DeviceFailure::kSilent:
      return "a kernel did not end in time";
  }
  return "";
}

}  // namespace jaywalk
