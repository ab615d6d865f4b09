#include "firmware/robot/realtime.h"

#include <fcntl.h>
#include <malloc.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <time.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "hal/types/errors.h"

namespace jaywalk {
namespace {

/// What a tick may need of the stack, and twice that.
constexpr std::size_t kStackBytes = 256 * 1024;

__attribute__((noinline)) void touch_stack() {
  std::array<unsigned char, kStackBytes> room;
  volatile unsigned char* const bytes = room.data();
  for (std::size_t at = 0; at < kStackBytes; at += 4096) bytes[at] = 0;
}

std::string refusal(const std::string& what, int error, const std::string& remedy) {
  return what + ": " + std::strerror(error) + "; " + remedy;
}

}  // namespace

std::vector<std::string> lock_memory() {
  ::mallopt(M_TRIM_THRESHOLD, -1);  // what was had once stays
  ::mallopt(M_MMAP_MAX, 0);
  if (::mlockall(MCL_CURRENT | MCL_FUTURE) == 0) return {};
  return {refusal("memory is not locked", errno, "run as root, or raise memlock: ulimit -l unlimited")};
}

void keep_processors_awake() noexcept {
  const int file = ::open("/dev/cpu_dma_latency", O_WRONLY | O_CLOEXEC);  // holds for as long as it is open
  const std::int32_t latency_us = 0;
  if (file >= 0 && ::write(file, &latency_us, sizeof latency_us) != sizeof latency_us) ::close(file);
}

std::vector<std::string> enter_realtime(const RealtimeWishes& wishes) {
  std::vector<std::string> refused;
  if (wishes.cpu) {
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET(static_cast<std::size_t>(*wishes.cpu), &one);
    const int error = ::pthread_setaffinity_np(::pthread_self(), sizeof one, &one);
    if (error != 0) refused.push_back(refusal("no processor of its own", error, "choose one that exists"));
  }
  if (wishes.priority > 0) {
    sched_param wanted{};
    wanted.sched_priority = wishes.priority;
    const int error = ::pthread_setschedparam(::pthread_self(), SCHED_FIFO, &wanted);
    if (error != 0)
      refused.push_back(refusal("no real-time priority", error, "run as root, or raise rtprio: ulimit -r 99"));
  }
  touch_stack();
  return refused;
}

void require_realtime(const RealtimeWishes& wishes, const std::vector<std::string>& not_permitted) {
  if (!wishes.required || not_permitted.empty()) return;
  throw StartupError(not_permitted.front(), "or start without it: --allow-no-realtime, or [realtime] required = false");
}

PageFaults page_faults() noexcept {
  rusage used{};
  if (::getrusage(RUSAGE_THREAD, &used) != 0) return {};
  return {static_cast<std::uint64_t>(used.ru_minflt), static_cast<std::uint64_t>(used.ru_majflt)};
}

void SteadyClock::sleep_until(Time wake) noexcept {
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(wake.time_since_epoch());
  const timespec until{.tv_sec = seconds.count(), .tv_nsec = (wake.time_since_epoch() - seconds).count()};
  while (::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
}

}  // namespace jaywalk
