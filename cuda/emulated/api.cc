// CUDA's calls on the emulated device.
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <utility>

#include "cuda/emulated/include/cuda_runtime.h"

namespace jaywalk::emulated {
namespace {

/// What a call returns: the sticky error where there is one, and it is remembered.
cudaError_t answer(cudaError_t error = cudaSuccess) {
  if (device().sticky() != 0) error = static_cast<cudaError_t>(device().sticky());
  if (error != cudaSuccess) device().last_error = error;
  return error;
}

/// One call: alone, and with the sticky error as its answer.
template <class Call>
cudaError_t call(const Call& what) {
  const std::lock_guard lock(device().mutex);
  if (device().sticky() != 0) return answer();
  return answer(what());
}

Device::Stream* stream_or_default(cudaStream_t stream) {
  return stream != nullptr ? stream : device().default_stream();
}

/// Reads or writes blocks of the device's as a copy does.
void touch(const void* to, const void* from, const std::function<void()>& work) {
  for (const void* block : {to, from}) device().memory().open(block, true);
  work();
  for (const void* block : {to, from}) device().memory().open(block, false);
}

}  // namespace

cudaError_t allocate(void** block, std::size_t bytes, Where where) {
  return call([&] {
    *block = device().memory().take(bytes, where, device().properties().bytes);
    return *block != nullptr ? cudaSuccess : cudaErrorMemoryAllocation;
  });
}

cudaError_t launch(const cudaLaunchConfig_t& config, std::function<void()> kernel) {
  return call([&] {
    const auto extent = [](const dim3& d) { return Extent{d.x, d.y, d.z}; };
    const Shape shape{extent(config.gridDim), extent(config.blockDim)};
    if (stream_or_default(config.stream)->of_device != Device::current()) return cudaErrorInvalidResourceHandle;
    const std::size_t threads = shape.block.count();
    if (shape.grid.count() == 0 || threads == 0 || threads > 1024) return cudaErrorInvalidConfiguration;
    return static_cast<cudaError_t>(device().launch(stream_or_default(config.stream), shape, std::move(kernel)));
  });
}

}  // namespace jaywalk::emulated

using namespace jaywalk::emulated;

const char* cudaGetErrorName(cudaError_t error) {
  switch (error) {
    case cudaSuccess:
      return "cudaSuccess";
    case cudaErrorInvalidValue:
      return "cudaErrorInvalidValue";
    case cudaErrorMemoryAllocation:
      return "cudaErrorMemoryAllocation";
    case cudaErrorInvalidConfiguration:
      return "cudaErrorInvalidConfiguration";
    case cudaErrorNoDevice:
      return "cudaErrorNoDevice";
    case cudaErrorInvalidDevice:
      return "cudaErrorInvalidDevice";
    case cudaErrorInvalidResourceHandle:
      return "cudaErrorInvalidResourceHandle";
    case cudaErrorNotReady:
      return "cudaErrorNotReady";
    case cudaErrorIllegalAddress:
      return "cudaErrorIllegalAddress";
    case cudaErrorLaunchOutOfResources:
      return "cudaErrorLaunchOutOfResources";
    case cudaErrorLaunchTimeout:
      return "cudaErrorLaunchTimeout";
    case cudaErrorLaunchFailure:
      return "cudaErrorLaunchFailure";
  }
  return "unrecognized error code";
}
const char* cudaGetErrorString(cudaError_t error) { return cudaGetErrorName(error); }

cudaError_t cudaGetLastError() {
  const std::lock_guard lock(device().mutex);
  const int error = std::exchange(device().last_error, device().sticky());
  return static_cast<cudaError_t>(error);
}

cudaError_t cudaGetDeviceCount(int* count) {
  return call([&] {
    *count = device().properties().devices;
    return *count > 0 ? cudaSuccess : cudaErrorNoDevice;
  });
}
cudaError_t cudaSetDevice(int number) {
  return call([&] {
    if (number < 0 || number >= device().properties().devices) return cudaErrorInvalidDevice;
    return Device::current() = number, cudaSuccess;
  });
}
cudaError_t cudaDeviceGetAttribute(int* value, cudaDeviceAttr attribute, int) {
  return call([&] {
    *value = attribute == cudaDevAttrManagedMemory || device().properties().integrated ? 1 : 0;
    return cudaSuccess;
  });
}
cudaError_t cudaDeviceGetStreamPriorityRange(int* least, int* greatest) {
  return call([&] { return *least = 0, *greatest = -5, cudaSuccess; });
}
cudaError_t cudaDeviceSynchronize() {
  return call([&] { return device().wait_for_all("cudaDeviceSynchronize"), cudaSuccess; });
}

cudaError_t cudaStreamCreateWithFlags(cudaStream_t* stream, unsigned flags) {
  return call([&] { return *stream = device().make_stream((flags & cudaStreamNonBlocking) == 0), cudaSuccess; });
}
cudaError_t cudaStreamCreateWithPriority(cudaStream_t* stream, unsigned flags, int) {
  return cudaStreamCreateWithFlags(stream, flags);
}
cudaError_t cudaStreamDestroy(cudaStream_t) { return answer(); }  // what it has in line still comes
cudaError_t cudaStreamSynchronize(cudaStream_t stream) {
  return call([&] { return device().wait(stream_or_default(stream), "cudaStreamSynchronize"), cudaSuccess; });
}

cudaError_t cudaEventCreate(cudaEvent_t* event) {
  return call([&] { return *event = device().make_event(), cudaSuccess; });
}
cudaError_t cudaEventCreateWithFlags(cudaEvent_t* event, unsigned) { return cudaEventCreate(event); }
cudaError_t cudaEventDestroy(cudaEvent_t) { return answer(); }
cudaError_t cudaEventRecord(cudaEvent_t event, cudaStream_t stream) {
  return call([&] { return device().record(event, stream_or_default(stream)), cudaSuccess; });
}
cudaError_t cudaEventQuery(cudaEvent_t event) {
  return call([&] { return device().is_done(event) ? cudaSuccess : cudaErrorNotReady; });
}
cudaError_t cudaEventSynchronize(cudaEvent_t event) {
  return call([&] { return device().wait(event, "cudaEventSynchronize"), cudaSuccess; });
}
cudaError_t cudaEventElapsedTime(float* ms, cudaEvent_t begin, cudaEvent_t end) {
  return call([&] {
    *ms = 0.0F;
    return begin->done == begin->recorded && end->done == end->recorded ? cudaSuccess : cudaErrorNotReady;
  });
}

cudaError_t cudaFree(void* block) {
  return call([&] {
    device().wait_for_all("cudaFree");
    return device().memory().release(block) ? cudaSuccess : cudaErrorInvalidValue;
  });
}
cudaError_t cudaFreeHost(void* block) {
  return call([&] {
    device().wait_for_all("cudaFreeHost");
    return device().memory().release(block) ? cudaSuccess : cudaErrorInvalidValue;
  });
}
cudaError_t cudaMemsetAsync(void* to, int value, std::size_t bytes, cudaStream_t stream) {
  return call([&] {
    device().later(stream_or_default(stream), [=] { touch(to, to, [=] { std::memset(to, value, bytes); }); });
    return cudaSuccess;
  });
}
cudaError_t cudaMemset(void* to, int value, std::size_t bytes) { return cudaMemsetAsync(to, value, bytes, nullptr); }
cudaError_t cudaMemcpyAsync(void* to, const void* from, std::size_t bytes, cudaMemcpyKind, cudaStream_t stream) {
  return call([&] {
    device().later(stream_or_default(stream), [=] { touch(to, from, [=] { std::memcpy(to, from, bytes); }); });
    return cudaSuccess;
  });
}
cudaError_t cudaMemcpy(void* to, const void* from, std::size_t bytes, cudaMemcpyKind kind) {
  const cudaError_t error = cudaMemcpyAsync(to, from, bytes, kind, nullptr);
  return error != cudaSuccess ? error : cudaStreamSynchronize(nullptr);
}
