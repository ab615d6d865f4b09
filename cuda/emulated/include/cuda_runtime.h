#pragma once
// What of CUDA's runtime the project calls, for its sources compiled by the host's compiler onto the emulated device.
// Names, numbers and what calls do are those of the CUDA runtime API's reference, 13.0.
#include <cstddef>
#include <cstdint>

#include "cuda/emulated/device_functions.h"

enum cudaError_t {
  cudaSuccess = 0,
  cudaErrorInvalidValue = 1,
  cudaErrorMemoryAllocation = 2,
  cudaErrorInvalidConfiguration = 9,
  cudaErrorNoDevice = 100,
  cudaErrorInvalidDevice = 101,
  cudaErrorInvalidResourceHandle = 400,
  cudaErrorNotReady = 600,
  cudaErrorIllegalAddress = 700,
  cudaErrorLaunchOutOfResources = 701,
  cudaErrorLaunchTimeout = 702,
  cudaErrorLaunchFailure = 719,
};
enum cudaDeviceAttr { cudaDevAttrIntegrated = 18, cudaDevAttrManagedMemory = 83 };
enum cudaMemcpyKind {
  cudaMemcpyHostToHost,
  cudaMemcpyHostToDevice,
  cudaMemcpyDeviceToHost,
  cudaMemcpyDeviceToDevice,
  cudaMemcpyDefault
};
inline constexpr unsigned cudaStreamNonBlocking = 1, cudaEventBlockingSync = 1, cudaEventDisableTiming = 2;
inline constexpr unsigned cudaHostAllocPortable = 1, cudaHostAllocMapped = 2, cudaMemAttachGlobal = 1;

using cudaStream_t = jaywalk::emulated::Device::Stream*;
using cudaEvent_t = jaywalk::emulated::Device::Event*;

struct cudaLaunchConfig_t {
  dim3 gridDim, blockDim;
  std::size_t dynamicSmemBytes;
  cudaStream_t stream;
};

const char* cudaGetErrorString(cudaError_t error);
const char* cudaGetErrorName(cudaError_t error);
cudaError_t cudaGetLastError();
cudaError_t cudaGetDeviceCount(int* count);
cudaError_t cudaSetDevice(int device);
cudaError_t cudaDeviceGetAttribute(int* value, cudaDeviceAttr attribute, int device);
cudaError_t cudaDeviceGetStreamPriorityRange(int* least, int* greatest);
cudaError_t cudaDeviceSynchronize();
cudaError_t cudaStreamCreateWithFlags(cudaStream_t* stream, unsigned flags);
cudaError_t cudaStreamCreateWithPriority(cudaStream_t* stream, unsigned flags, int priority);
cudaError_t cudaStreamDestroy(cudaStream_t stream);
cudaError_t cudaStreamSynchronize(cudaStream_t stream);
cudaError_t cudaEventCreate(cudaEvent_t* event);
cudaError_t cudaEventCreateWithFlags(cudaEvent_t* event, unsigned flags);
cudaError_t cudaEventDestroy(cudaEvent_t event);
cudaError_t cudaEventRecord(cudaEvent_t event, cudaStream_t stream = nullptr);
cudaError_t cudaEventQuery(cudaEvent_t event);
cudaError_t cudaEventSynchronize(cudaEvent_t event);
cudaError_t cudaEventElapsedTime(float* ms, cudaEvent_t begin, cudaEvent_t end);
cudaError_t cudaFree(void* block);
cudaError_t cudaFreeHost(void* block);
cudaError_t cudaMemset(void* to, int value, std::size_t bytes);
cudaError_t cudaMemsetAsync(void* to, int value, std::size_t bytes, cudaStream_t stream = nullptr);
cudaError_t cudaMemcpy(void* to, const void* from, std::size_t bytes, cudaMemcpyKind kind);
cudaError_t cudaMemcpyAsync(void* to, const void* from, std::size_t bytes, cudaMemcpyKind kind,
                            cudaStream_t stream = nullptr);

namespace jaywalk::emulated {
cudaError_t allocate(void** block, std::size_t bytes, Where where);
cudaError_t launch(const cudaLaunchConfig_t& config, std::function<void()> kernel);
}  // namespace jaywalk::emulated

template <class T>
cudaError_t cudaMalloc(T** block, std::size_t bytes) {
  return jaywalk::emulated::allocate(reinterpret_cast<void**>(block), bytes, jaywalk::emulated::Where::kDevice);
}
template <class T>
cudaError_t cudaHostAlloc(T** block, std::size_t bytes, unsigned) {
  return jaywalk::emulated::allocate(reinterpret_cast<void**>(block), bytes, jaywalk::emulated::Where::kPinned);
}
template <class T>
cudaError_t cudaMallocManaged(T** block, std::size_t bytes, unsigned = cudaMemAttachGlobal) {
  return jaywalk::emulated::allocate(reinterpret_cast<void**>(block), bytes, jaywalk::emulated::Where::kManaged);
}
template <class... Parameters, class... Arguments>
cudaError_t cudaLaunchKernelEx(const cudaLaunchConfig_t* config, void (*kernel)(Parameters...),
                               Arguments&&... arguments) {
  // As a launch does, this keeps copies of the arguments.
  return jaywalk::emulated::launch(*config, [kernel, ... kept = Parameters(arguments)] { kernel(kept...); });
}
