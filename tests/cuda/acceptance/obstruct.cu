// What keeps a real device from serving.
#include <cuda_runtime.h>

#include <cstdio>

#include "tests/cuda/acceptance/acceptance.h"

namespace jaywalk::acceptance {
namespace {

__global__ void spin(long long ns) {
  long long begin = 0, now = 0;
  asm volatile("mov.u64 %0, %%globaltimer;" : "=l"(begin));
  do asm volatile("mov.u64 %0, %%globaltimer;" : "=l"(now));
  while (ns <= 0 || now - begin < ns);
}
__global__ void trap() { asm volatile("trap;"); }

int attribute(cudaDeviceAttr which) {
  int value = 0;
  (void)cudaDeviceGetAttribute(&value, which, 0);
  return value;
}

}  // namespace

/// As many blocks as are resident at a time, of all the memory that a block may have: no other block fits.
bool occupy(bool for_good) {
  const int most = attribute(cudaDevAttrMaxSharedMemoryPerBlockOptin);
  cudaStream_t stream = nullptr;
  if (cudaStreamCreateWithFlags(&stream, cudaStreamNonBlocking) != cudaSuccess) return false;
  if (cudaFuncSetAttribute(spin, cudaFuncAttributeMaxDynamicSharedMemorySize, most) != cudaSuccess) return false;
  spin<<<attribute(cudaDevAttrMultiProcessorCount), 1024, most, stream>>>(for_good ? 0 : 500'000'000LL);
  return cudaGetLastError() == cudaSuccess;
}

bool break_device() {
  trap<<<1, 1>>>();
  return cudaDeviceSynchronize() != cudaSuccess;
}

bool fill_memory() {
  void* block = nullptr;
  for (std::size_t bytes = std::size_t{1} << 38; bytes >= std::size_t{1} << 20; bytes /= 2) {
    while (cudaMalloc(&block, bytes) == cudaSuccess) {
    }
    (void)cudaGetLastError();
  }
  return true;
}

std::string description() {
  cudaDeviceProp p{};
  int driver = 0, runtime = 0;
  if (cudaGetDeviceProperties(&p, 0) != cudaSuccess) return "\"device\": null";
  (void)cudaDriverGetVersion(&driver), (void)cudaRuntimeGetVersion(&runtime);
  char text[512];
  std::snprintf(text, sizeof text,
                "\"device\": \"%s\", \"compute\": \"%d.%d\", \"processors\": %d, \"l2_mb\": %d, \"integrated\": %d, "
                "\"clock_mhz\": %d, \"driver\": %d, \"runtime\": %d",
                p.name, p.major, p.minor, p.multiProcessorCount, p.l2CacheSize >> 20, p.integrated,
                attribute(cudaDevAttrClockRate) / 1000, driver, runtime);
  return text;
}

}  // namespace jaywalk::acceptance
