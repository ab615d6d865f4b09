#include "cuda/emulated/device.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <utility>

#include "cuda/emulated/poison.h"

namespace jaywalk::emulated {
namespace {

// CUDA's numbers (driver_types.h).
constexpr int kOutOfResources = 701, kIllegalAddress = 700, kTimeout = 702, kLaunchFailure = 719;

[[noreturn]] void never_returns(const char* call) {
  std::fprintf(stderr, "emulated CUDA: %s waits for a kernel that never ends\n", call);
  std::abort();
}

}  // namespace

Device& device() {
  static auto* const only = new Device;  // outlives what is destroyed at the program's end and still calls it
  static const bool is_on = [] {
    only->power_on();
    std::atexit([] {
      if (only->is_stuck()) never_returns("the driver's part of exit()");
    });
    return true;
  }();
  (void)is_on;
  return *only;
}

int& Device::current() {
  thread_local int number = 0;
  return number;
}

void Device::power_on(const Properties& properties) {
  const std::lock_guard lock(mutex);
  properties_ = properties;
  counts_ = {};
  random_ = OrderRandom(properties.seed);
  poison_byte = properties.seed % 2 == 0 ? 0xff : 0xcd;
  memory_.set_busy(false);
  memory_.begin_anew(properties.guarded);
  streams_.clear(), events_.clear();
  current() = 0;
  default_stream_ = make_stream(true);
  fault_ = Fault::kNone;
  sticky_ = last_error = 0;
}

void Device::order(Fault fault, int after_launches, int times) {
  fault_ = fault, fault_after_ = after_launches, fault_times_ = times;
}

void Device::delay(int not_ready) {
  properties_.not_ready = not_ready;
  for (Event& event : events_) event.not_ready = std::min(event.not_ready, not_ready);
}

bool Device::is_stuck() const {
  return std::any_of(streams_.begin(), streams_.end(), [](const Stream& stream) { return stream.is_stuck; });
}

Device::Stream* Device::make_stream(bool waits_for_default) {
  return &streams_.emplace_back(Stream{{}, waits_for_default});
}
Device::Event* Device::make_event() { return &events_.emplace_back(); }

Fault Device::next_fault() {
  if (fault_ == Fault::kNone || fault_after_-- > 0) return Fault::kNone;
  fault_after_ = 0;
  return std::exchange(fault_, --fault_times_ > 0 ? fault_ : Fault::kNone);
}

int Device::launch(Stream* stream, const Shape& shape, std::function<void()> kernel) {
  const Fault fault = next_fault();
  if (fault == Fault::kRefused) return kOutOfResources;
  stream->line.push_back(
      {[this, stream, shape, kernel = std::move(kernel), fault] { run(*stream, shape, kernel, fault); }, true});
  note_busy();
  return 0;
}

void Device::later(Stream* stream, std::function<void()> work) { stream->line.push_back({std::move(work), false}); }

void Device::record(Event* event, Stream* stream) {
  event->stream = stream;
  event->not_ready = properties_.not_ready;
  later(stream, [event, number = ++event->recorded] { event->done = number; });
}

void Device::run(Stream& stream, const Shape& shape, const std::function<void()>& kernel, Fault fault) {
  if (fault == Fault::kHangs) {
    stream.is_stuck = true;
    return;
  }
  memory_.begin_work();
  const Ended how = launch_->run(shape, kernel, random_, properties_.most_barriers, counts_);
  memory_.end_work();
  stream.is_stuck = how == Ended::kNever;
  if (how == Ended::kTooLong) sticky_ = kTimeout;
  if (how == Ended::kOffStack) sticky_ = kLaunchFailure;
  if (fault == Fault::kBroken) sticky_ = kIllegalAddress;
  if (how != Ended::kWell && !stream.is_stuck)
    std::fprintf(stderr, "emulated CUDA: a kernel was ended by error %d\n", sticky_);
}

bool Device::advance(Stream& stream) {
  if (sticky_ != 0) stream.line.clear();
  if (stream.line.empty() || stream.is_stuck) return false;
  if (&stream != default_stream_ && stream.waits_for_default && advance(*default_stream_)) return true;
  const Stream::Work work = std::move(stream.line.front());
  stream.line.pop_front();
  work.run();
  note_busy();
  return !stream.is_stuck;
}

void Device::note_busy() {
  memory_.set_busy(std::any_of(streams_.begin(), streams_.end(), [](const Stream& stream) {
    return stream.is_stuck ||
           std::any_of(stream.line.begin(), stream.line.end(), [](const auto& work) { return work.is_kernel; });
  }));
}

bool Device::is_done(Event* event) {
  if (event->done == event->recorded) return true;
  if (event->not_ready > 0) {
    --event->not_ready;
    return false;
  }
  while (event->done != event->recorded && advance(*event->stream)) {
  }
  return event->done == event->recorded;
}

void Device::wait(Event* event, const char* call) {
  event->not_ready = 0;
  if (!is_done(event) && sticky_ == 0) never_returns(call);
}

void Device::wait(Stream* stream, const char* call) {
  if (stream == default_stream_) {
    for (Stream& other : streams_) {
      if (&other != stream && other.waits_for_default) wait(&other, call);
    }
  }
  while (advance(*stream)) {
  }
  if (stream->is_stuck) never_returns(call);
}

void Device::wait_for_all(const char* call) {
  for (Stream& stream : streams_) wait(&stream, call);
}

}  // namespace jaywalk::emulated
