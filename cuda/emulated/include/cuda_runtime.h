#pragma once
// What of CUDA the project uses, for its sources compiled by the host's compiler onto the emulated device. Names,
// numbers and what calls do are those of the CUDA runtime API's reference, 13.0.
#include <bit>
#include <cstddef>
#include <utility>

#include "cuda/emulated/block.h"

// For kernels. One block runs at a time, and its fibers give way at barriers alone: so shared memory is static, and
// plain code is atomic.
#define __global__
#define __device__
#define __host__
#define __grid_constant__
#define __launch_bounds__(...)
#define __shared__ static
#define __CUDA_ARCH__ 900

using jaywalk::emulated::threadIdx, jaywalk::emulated::blockIdx, jaywalk::emulated::blockDim;

inline void __syncthreads() { jaywalk::emulated::meet_block(); }
inline int __clz(int n) { return std::countl_zero(static_cast<unsigned>(n)); }

template <class T>
T atomicAdd(T* at, T by) {
  return std::exchange(*at, static_cast<T>(*at + by));
}
template <class T>
T atomicMin(T* at, T with) {
  return std::exchange(*at, with < *at ? with : *at);
}

// For the host.
enum cudaError_t {
  cudaSuccess = 0,
  cudaErrorMemoryAllocation = 2,
  cudaErrorNoDevice = 100,
  cudaErrorInvalidDevice = 101,
  cudaErrorInvalidResourceHandle = 400,
  cudaErrorNotReady = 600,
  cudaErrorIllegalAddress = 700,
  cudaErrorLaunchOutOfResources = 701,
  cudaErrorLaunchFailure = 719,
};
enum cudaMemcpyKind { cudaMemcpyDefault = 4 };
inline constexpr unsigned cudaStreamNonBlocking = 1, cudaHostAllocPortable = 1;

using cudaStream_t = struct CUstream_st*;
using cudaEvent_t = struct CUevent_st*;

struct dim3 {
  unsigned x, y, z;
  constexpr dim3(unsigned of_x = 1, unsigned of_y = 1, unsigned of_z = 1) : x(of_x), y(of_y), z(of_z) {}
};
struct cudaLaunchConfig_t {
  dim3 gridDim, blockDim;
  cudaStream_t stream;
};

const char* cudaGetErrorString(cudaError_t error);
cudaError_t cudaGetLastError();
cudaError_t cudaGetDeviceCount(int* count);
cudaError_t cudaSetDevice(int device);
cudaError_t cudaDeviceGetStreamPriorityRange(int* least, int* greatest);
cudaError_t cudaStreamCreateWithPriority(cudaStream_t* stream, unsigned flags, int priority);
cudaError_t cudaStreamDestroy(cudaStream_t stream);
cudaError_t cudaStreamSynchronize(cudaStream_t stream);
cudaError_t cudaEventCreate(cudaEvent_t* event);
cudaError_t cudaEventDestroy(cudaEvent_t event);
cudaError_t cudaEventRecord(cudaEvent_t event, cudaStream_t stream);
cudaError_t cudaEventQuery(cudaEvent_t event);
cudaError_t cudaEventSynchronize(cudaEvent_t event);
cudaError_t cudaEventElapsedTime(float* ms, cudaEvent_t begin, cudaEvent_t end);
cudaError_t cudaMalloc(void** block, std::size_t bytes);
cudaError_t cudaHostAlloc(void** block, std::size_t bytes, unsigned flags);
cudaError_t cudaFree(void* block);
cudaError_t cudaFreeHost(void* block);
cudaError_t cudaMemsetAsync(void* to, int value, std::size_t bytes, cudaStream_t stream);
cudaError_t cudaMemcpyAsync(void* to, const void* from, std::size_t bytes, cudaMemcpyKind kind, cudaStream_t stream);

namespace jaywalk::emulated {
cudaError_t launch(const cudaLaunchConfig_t& config, std::function<void()> kernel);
}  // namespace jaywalk::emulated

template <class... Parameters, class... Arguments>
cudaError_t cudaLaunchKernelEx(const cudaLaunchConfig_t* config, void (*kernel)(Parameters...),
                               Arguments&&... arguments) {
  // As a launch does, this keeps copies of the arguments.
  return jaywalk::emulated::launch(*config, [kernel, ... kept = Parameters(arguments)] { kernel(kept...); });
}
