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

cudaError_t launch(const cudaLaunchConfig_t& config, const void* function, std::function<void()> kernel) {
  return call([&] {
    const Properties& properties = device().properties();
    const auto extent = [](const dim3& d) { return Extent{d.x, d.y, d.z}; };
    Shape shape{extent(config.gridDim), extent(config.blockDim), 1, false, config.dynamicSmemBytes};
    for (unsigned k = 0; k < config.numAttrs; ++k) {
      const cudaLaunchAttribute& attribute = config.attrs[k];
      if (attribute.id == cudaLaunchAttributeCooperative) shape.cooperative = attribute.val.cooperative != 0;
      if (attribute.id == cudaLaunchAttributeClusterDimension) shape.cluster_blocks = attribute.val.clusterDim.x;
    }
    if (stream_or_default(config.stream)->of_device != Device::current()) return cudaErrorInvalidResourceHandle;
    const std::size_t blocks = shape.grid.count(), threads = shape.block.count();
    if (blocks == 0 || threads == 0 || threads > 1024) return cudaErrorInvalidConfiguration;
    if (shape.dynamic_bytes > device().functions[function].dynamic_bytes) return cudaErrorInvalidValue;
    if (shape.cooperative && blocks > static_cast<std::size_t>(properties.processors))
      return cudaErrorCooperativeLaunchTooLarge;
    int clusters = 1;
    if (shape.cluster_blocks > 1) (void)clusters_at_a_time(&clusters, function, config);
    if (clusters == 0 || blocks % shape.cluster_blocks != 0) return cudaErrorInvalidConfiguration;
    return static_cast<cudaError_t>(device().launch(stream_or_default(config.stream), shape, std::move(kernel)));
  });
}

cudaError_t attributes(cudaFuncAttributes* attributes) {
  return call([&] {
    const int version = device().properties().compute_capability;
    *attributes = {version, version, 128, 1024, 0, 0};
    return cudaSuccess;
  });
}

cudaError_t set_attribute(const void* function, cudaFuncAttribute attribute, int value) {
  return call([&] {
    Device::Function& of = device().functions[function];
    if (attribute == cudaFuncAttributeNonPortableClusterSizeAllowed) {
      if (device().properties().compute_capability < 90) return cudaErrorNotSupported;
      of.any_cluster = value != 0;
      return cudaSuccess;
    }
    if (value < 0 || static_cast<std::size_t>(value) > kMostSharedBytes) return cudaErrorInvalidValue;
    of.dynamic_bytes = static_cast<std::size_t>(value);
    return cudaSuccess;
  });
}

cudaError_t blocks_at_a_time(int* blocks, int threads, std::size_t dynamic_bytes) {
  return call([&] {
    *blocks = threads <= 1024 && dynamic_bytes <= kMostSharedBytes ? 1 : 0;
    return cudaSuccess;
  });
}

cudaError_t clusters_at_a_time(int* clusters, const void* function, const cudaLaunchConfig_t& config) {
  return call([&] {
    unsigned blocks = 1;
    for (unsigned k = 0; k < config.numAttrs; ++k) {
      if (config.attrs[k].id == cudaLaunchAttributeClusterDimension) blocks = config.attrs[k].val.clusterDim.x;
    }
    const bool is_large = blocks > 8 && !device().functions[function].any_cluster;
    *clusters = !is_large && static_cast<int>(blocks) <= device().properties().cluster_blocks ? 1 : 0;
    return is_large ? cudaErrorInvalidConfiguration : cudaSuccess;
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
    case cudaErrorCooperativeLaunchTooLarge:
      return "cudaErrorCooperativeLaunchTooLarge";
    case cudaErrorNotSupported:
      return "cudaErrorNotSupported";
  }
  return "unrecognized error code";
}
const char* cudaGetErrorString(cudaError_t error) { return cudaGetErrorName(error); }

cudaError_t cudaGetLastError() {
  const std::lock_guard lock(device().mutex);
  const int error = std::exchange(device().last_error, device().sticky());
  return static_cast<cudaError_t>(error);
}
cudaError_t cudaPeekAtLastError() { return static_cast<cudaError_t>(device().last_error); }

cudaError_t cudaGetDeviceCount(int* count) {
  return call([&] {
    *count = device().properties().devices;
    return *count > 0 ? cudaSuccess : cudaErrorNoDevice;
  });
}
cudaError_t cudaGetDevice(int* number) {
  return call([&] {
    *number = Device::current();
    return device().properties().devices > 0 ? cudaSuccess : cudaErrorNoDevice;
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
    const Properties& properties = device().properties();
    switch (attribute) {
      case cudaDevAttrMultiProcessorCount:
        *value = properties.processors;
        break;
      case cudaDevAttrIntegrated:
        *value = properties.integrated ? 1 : 0;
        break;
      case cudaDevAttrComputeCapabilityMajor:
        *value = properties.compute_capability / 10;
        break;
      case cudaDevAttrComputeCapabilityMinor:
        *value = properties.compute_capability % 10;
        break;
      case cudaDevAttrMaxSharedMemoryPerBlockOptin:
        *value = static_cast<int>(jaywalk::kMostSharedBytes);
        break;
      case cudaDevAttrManagedMemory:
      case cudaDevAttrCooperativeLaunch:
        *value = 1;
        break;
    }
    return cudaSuccess;
  });
}
cudaError_t cudaGetDeviceProperties(cudaDeviceProp* of, int) {
  return call([&] {
    const Properties& properties = device().properties();
    *of = {"emulated",
           properties.compute_capability / 10,
           properties.compute_capability % 10,
           properties.integrated ? 1 : 0,
           properties.processors,
           properties.bytes};
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
cudaError_t cudaStreamWaitEvent(cudaStream_t stream, cudaEvent_t event, unsigned) {
  return call([&] {
    device().later(stream_or_default(stream), [event] { device().wait(event, "cudaStreamWaitEvent"); });
    return cudaSuccess;
  });
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
