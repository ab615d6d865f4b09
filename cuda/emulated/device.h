#pragma once
// An emulated CUDA device on one thread of the CPU. Kernels are the project's own, compiled by the host's compiler;
// what is launched runs when something waits for it, so that a wait that is missing shows. cuda/README.md.
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>

#include "cuda/emulated/launch.h"
#include "cuda/emulated/memory.h"

namespace jaywalk::emulated {

struct Properties {
  int devices = 1;          ///< all alike; 0: none is there
  bool integrated = false;  ///< one memory, as on a Jetson
  bool guarded = false;     ///< the host cannot touch what is not its own (memory.h)
  std::size_t bytes = std::size_t{4} << 30;
  int not_ready = 0;                     ///< times that each event is said to be still ahead
  std::uint64_t seed = 1;                ///< of the order in which threads run
  std::int64_t most_barriers = 1 << 18;  ///< of one launch; beyond, it is ended as by a watchdog
};

/// What a launch can be ordered to come to.
enum class Fault : std::uint8_t {
  kNone,
  kRefused,  ///< it is refused; the next is not
  kBroken,   ///< it fails, and with it all that is called from then on: the error is sticky
  kHangs,    ///< it never ends
};

class Device {
 public:
  /// As newly switched on: nothing is launched, no memory taken, no fault ordered.
  void power_on(const Properties& properties = {});
  /// The launch after so many more, and `times` in all.
  void order(Fault fault, int after_launches = 0, int times = 1);

  /// From now on each event is said to be still ahead so often.
  void delay(int not_ready);
  /// From now on there is no room for more memory.
  void fill() { properties_.bytes = 0; }

  [[nodiscard]] const Properties& properties() const { return properties_; }
  [[nodiscard]] Counts counts() const { return counts_; }
  /// Whether a kernel was left that never ends.
  [[nodiscard]] bool is_stuck() const;

  // What the calls of include/cuda_runtime.h are made of (api.cc). Errors are CUDA's numbers.
  struct Stream;
  struct Event;
  Stream* make_stream(bool waits_for_default);
  Event* make_event();
  /// 0 or the reason for which the launch is refused.
  int launch(Stream* stream, const Shape& shape, std::function<void()> kernel);
  void later(Stream* stream, std::function<void()> work);
  void record(Event* event, Stream* stream);
  [[nodiscard]] bool is_done(Event* event);
  /// Runs all that the host waits for. A wait that would never end ends the program, with `call` in its last words.
  void wait(Event* event, const char* call);
  void wait(Stream* stream, const char* call);
  void wait_for_all(const char* call);
  [[nodiscard]] int sticky() const { return sticky_; }
  [[nodiscard]] Memory& memory() { return memory_; }
  [[nodiscard]] Stream* default_stream() { return default_stream_; }
  /// The device that the calling thread works on, as cudaSetDevice() has it: each begins with 0.
  [[nodiscard]] static int& current();

  std::recursive_mutex mutex;  ///< of all calls
  int last_error = 0;

 private:
  /// Runs what is first in line. False: it is stuck, or nothing is there.
  bool advance(Stream& stream);
  void run(Stream& stream, const Shape& shape, const std::function<void()>& kernel, Fault fault);
  [[nodiscard]] Fault next_fault();
  void note_busy();

  Properties properties_;
  Counts counts_;
  OrderRandom random_{1};
  Memory memory_;
  std::unique_ptr<Launch> launch_ = std::make_unique<Launch>();
  std::deque<Stream> streams_;
  std::deque<Event> events_;
  Stream* default_stream_ = nullptr;
  Fault fault_ = Fault::kNone;
  int fault_after_ = 0, fault_times_ = 0;
  int sticky_ = 0;
};

struct Device::Stream {
  struct Work {
    std::function<void()> run;
    bool is_kernel;
  };
  std::deque<Work> line;
  bool waits_for_default, is_stuck = false;
  int of_device = current();
};

struct Device::Event {
  Stream* stream = nullptr;
  std::uint64_t recorded = 0, done = 0;
  int not_ready = 0;
};

/// The one that the program has.
[[nodiscard]] Device& device();

}  // namespace jaywalk::emulated
