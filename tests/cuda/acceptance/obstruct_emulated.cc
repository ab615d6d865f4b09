#include <mutex>
#include <thread>

#include "cuda/emulated/device.h"
#include "tests/cuda/acceptance/acceptance.h"

namespace jaywalk::acceptance {

using emulated::Fault;

bool occupy(bool for_good) {
  if (for_good) return emulated::device().order(Fault::kHangs), true;
  emulated::device().delay(1 << 30);
  std::thread([] {
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    const std::lock_guard lock(emulated::device().mutex);
    emulated::device().delay(0);
  }).detach();
  return true;
}
bool break_device() { return emulated::device().order(Fault::kBroken), true; }
bool fill_memory() { return emulated::device().memory.fill(), true; }
std::string description() { return "\"device\": \"emulated\""; }

}  // namespace jaywalk::acceptance
