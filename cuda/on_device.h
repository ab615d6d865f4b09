#pragma once
#include <cuda_runtime.h>

#include <exception>
#include <string>

namespace jaywalk {

/// Returns make()'s result on a device. Null, and the reason in `why_not`, without such a device or where it fails.
template <class Make>
auto on_device(int device, std::string& why_not, const Make& make) -> decltype(make()) {
  int devices = 0;
  const cudaError_t found = cudaGetDeviceCount(&devices);
  if (found != cudaSuccess || devices == 0) {
    why_not = std::string("cuda: no device (") + cudaGetErrorString(found) + ")";
    return nullptr;
  }
  if (device >= devices) {
    why_not = "cuda: no device " + std::to_string(device) + " (" + std::to_string(devices) + " there, numbered from 0)";
    return nullptr;
  }
  try {
    return make();
  } catch (const std::exception& error) {
    why_not = std::string("cuda: the device does not serve (") + error.what() + ")";
    return nullptr;
  }
}

}  // namespace jaywalk
