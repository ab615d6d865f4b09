#pragma once
#include <atomic>
#include <cstdint>
#include <memory>
#include <thread>

#include "drivers/wire/file_descriptor.h"

namespace jaywalk {

/// While it lives, nothing in this process waits for standard error: what is written there goes into a pipe that never
/// blocks, and a thread of this class passes it on to the terminal, file or pipe that was there. Where that does not
/// take it (Ctrl-S, a reader that sleeps or is gone), lines beyond the pipe's 64 kB are lost and counted.
///
/// Its end waits half a second for what is still to be passed on, then gives it up. Start-up and end: one thread.
class StderrRelay {
 public:
  /// Where no pipe can be made standard error stays as it is, and may block.
  StderrRelay();
  ~StderrRelay();
  StderrRelay(const StderrRelay&) = delete;
  StderrRelay& operator=(const StderrRelay&) = delete;

 private:
  struct Ends {
    wire::FileDescriptor pipe, out;  ///< out: what standard error was
    std::atomic<bool> done{false};
  };
  static void pass_on(Ends& ends) noexcept;

  std::shared_ptr<Ends> ends_;  ///< shared with the thread, which may outlast this one in a write that never ends
  std::thread thread_;
};

/// A line of the program's for a person, on standard error. Where that takes none the line is lost, and the next that
/// is taken says how many were. Any thread but the loop's.
void remark(const std::string& text);

}  // namespace jaywalk
