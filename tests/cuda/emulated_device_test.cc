// The emulated device tells what is wrong with a kernel or with how it is launched.
#include <sys/wait.h>
#include <unistd.h>

#include <bit>
#include <cstring>
#include <limits>
#include <set>
#include <vector>

#include "cuda/emulated/device.h"
#include "tests/cuda/sample_kernels.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::test;

namespace {

/// A stream and device memory for ints, on a device newly switched on.
struct Rig {
  explicit Rig(const emulated::Properties& properties = {}, std::size_t n = 4096) : count(n) {
    emulated::device().power_on(properties);
    REQUIRE(cudaStreamCreateWithPriority(&stream, cudaStreamNonBlocking, 0) == cudaSuccess);
    REQUIRE(cudaMalloc(reinterpret_cast<void**>(&ints), n * sizeof(int)) == cudaSuccess);
    REQUIRE(cudaEventCreate(&event) == cudaSuccess);
  }
  ~Rig() { emulated::device().power_on(); }
  Rig(const Rig&) = delete;
  Rig& operator=(const Rig&) = delete;

  template <class... Arguments>
  cudaError_t launch(Launched how, void (*kernel)(Arguments...), Arguments... arguments) {
    return launch_sample(how, stream, kernel, arguments...);
  }
  /// What the kernels so far have left. Waits for them.
  std::vector<int> result() {
    std::vector<int> values(count);
    REQUIRE(cudaMemcpyAsync(values.data(), ints, count * sizeof(int), cudaMemcpyDefault, stream) == cudaSuccess);
    REQUIRE(cudaStreamSynchronize(stream) == cudaSuccess);
    return values;
  }

  std::size_t count;
  cudaStream_t stream = nullptr;
  cudaEvent_t event = nullptr;
  int* ints = nullptr;
};

/// The signal that ends a process which does this, or 0.
template <class Act>
int signal_of(const Act& act) {
  const pid_t child = ::fork();
  if (child == 0) {
    ::close(STDERR_FILENO);
    ::signal(SIGSEGV, SIG_DFL), ::signal(SIGABRT, SIG_DFL);
    act();
    ::_exit(0);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFSIGNALED(status) ? WTERMSIG(status) : 0;
}

}  // namespace

TEST_CASE("every thread of every block runs once, and knows its place") {
  Rig rig;
  REQUIRE(rig.launch({.blocks = 3, .threads = 96}, add_place, rig.ints) == cudaSuccess);
  const std::vector<int> values = rig.result();
  for (std::size_t k = 0; k < 288; ++k) REQUIRE(values[k] == static_cast<int>(k));
  CHECK(emulated::device().counts.launches == 1);
}

TEST_CASE("a block that meets sums right in every order, one that does not sums wrong in some") {
  std::set<int> with, without;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    for (const bool meets : {true, false}) {
      Rig rig({.seed = seed});
      const auto kernel = meets ? sum_of_block<true> : sum_of_block<false>;
      REQUIRE(rig.launch({.blocks = 1, .threads = 128}, kernel, rig.ints) == cudaSuccess);
      (meets ? with : without).insert(rig.result()[0]);
    }
  }
  CHECK(with == std::set<int>{128 * 127 / 2});
  CHECK(without.size() > 1);
}

TEST_CASE("a barrier that some threads leave out never opens") {
  Rig rig;
  REQUIRE(rig.launch({.blocks = 1, .threads = 64}, meet_by_halves, rig.ints) == cudaSuccess);
  REQUIRE(cudaEventRecord(rig.event, rig.stream) == cudaSuccess);
  CHECK(cudaEventQuery(rig.event) == cudaErrorNotReady);
  CHECK(emulated::device().is_stuck);
}

TEST_CASE("a launch runs when something waits for it, and not before") {
  Rig rig({.not_ready = 2});
  int* pinned = nullptr;
  REQUIRE(cudaHostAlloc(reinterpret_cast<void**>(&pinned), 64 * sizeof(int), cudaHostAllocPortable) == cudaSuccess);
  pinned[3] = -1;
  REQUIRE(rig.launch({.blocks = 1, .threads = 64}, add_place, pinned) == cudaSuccess);
  REQUIRE(cudaEventRecord(rig.event, rig.stream) == cudaSuccess);
  CHECK(pinned[3] == -1);
  CHECK(cudaEventQuery(rig.event) == cudaErrorNotReady);
  CHECK(cudaGetLastError() == cudaErrorNotReady);  // as CUDA has it
  CHECK(cudaEventQuery(rig.event) == cudaErrorNotReady);
  CHECK(pinned[3] == -1);
  CHECK(cudaEventQuery(rig.event) == cudaSuccess);
  CHECK(pinned[3] == 3);
}

TEST_CASE("memory of the device is poisoned, ends where it ends, and is not the host's") {
  Rig rig({.guarded = true}, 64);
  CHECK(rig.result()[7] == static_cast<int>(0xcdcdcdcd));
  CHECK(signal_of([&] { rig.ints[0] = 1; }) == SIGSEGV);
  CHECK(signal_of([&] {
          (void)rig.launch({.blocks = 2, .threads = 64}, add_place, rig.ints);  // twice as many as there is room for
          (void)cudaStreamSynchronize(rig.stream);
        }) == SIGSEGV);
}

TEST_CASE("errors to order: one launch refused, all broken from then on, one that never ends") {
  Rig rig;
  const Launched one{.blocks = 1, .threads = 32};
  emulated::device().order(emulated::Fault::kRefused, 1);
  CHECK(rig.launch(one, add_place, rig.ints) == cudaSuccess);
  CHECK(rig.launch(one, add_place, rig.ints) == cudaErrorLaunchOutOfResources);
  CHECK(rig.launch(one, add_place, rig.ints) == cudaSuccess);
  CHECK(cudaGetLastError() == cudaErrorLaunchOutOfResources);
  CHECK(cudaGetLastError() == cudaSuccess);
  emulated::device().order(emulated::Fault::kHangs);
  CHECK(rig.launch(one, add_place, rig.ints) == cudaSuccess);
  CHECK(cudaEventRecord(rig.event, rig.stream) == cudaSuccess);
  for (int k = 0; k < 10; ++k) CHECK(cudaEventQuery(rig.event) == cudaErrorNotReady);
  CHECK(signal_of([&] { (void)cudaEventSynchronize(rig.event); }) == SIGABRT);
  CHECK(signal_of([&] { (void)cudaFree(rig.ints); }) == SIGABRT);
  CHECK(signal_of([&] { std::exit(0); }) == SIGABRT);
  CHECK(signal_of([&] { std::_Exit(0); }) == 0);
  emulated::device().power_on();
  Rig other;
  emulated::device().order(emulated::Fault::kBroken);
  CHECK(other.launch(one, add_place, other.ints) == cudaSuccess);
  CHECK(cudaStreamSynchronize(other.stream) == cudaErrorIllegalAddress);
  CHECK(cudaFree(other.ints) == cudaErrorIllegalAddress);
}

#if JAYWALK_EMULATES_NAN
TEST_CASE("a NaN that comes from arithmetic is NVIDIA's, one that is copied stays what it was") {
  Rig rig;
  REQUIRE(rig.launch({.blocks = 1, .threads = 1}, nans, rig.ints, std::numeric_limits<float>::quiet_NaN()) ==
          cudaSuccess);
  // Copied, + 1, 0 / 0, infinity - infinity, 1.5, the square root of -1.
  constexpr int kMade = 0x7fffffff;
  const std::vector<int> wanted{0x7fc00000, kMade, kMade, kMade, std::bit_cast<int>(1.5F), kMade};
  const std::vector<int> values = rig.result();
  CHECK(std::vector<int>(values.begin(), values.begin() + 6) == wanted);
}
#endif
