#include "firmware/robot/stderr_relay.h"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <string>

#include "drivers/wire/thread_without_signals.h"

namespace jaywalk {
namespace {

constexpr std::chrono::milliseconds kPatience{500}, kPause{10};

std::atomic<std::uint64_t> lines_lost{0};

}  // namespace

StderrRelay::StderrRelay() {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) return;
  wire::FileDescriptor entry(ends[1]);
  ends_ = std::make_shared<Ends>();
  ends_->pipe = wire::FileDescriptor(ends[0]);
  ends_->out = wire::FileDescriptor(::fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, STDERR_FILENO + 1));
  ::fcntl(entry.get(), F_SETFL, O_NONBLOCK);  // of this end alone
  ::dup2(entry.get(), STDERR_FILENO);
  thread_ = thread_without_signals("said", [ends = ends_] { pass_on(*ends); });
}

StderrRelay::~StderrRelay() {
  if (!ends_) return;
  ::dup2(ends_->out.get(), STDERR_FILENO);  // the pipe's last writer is gone: its reader comes to the end
  for (auto waited = kPause; !ends_->done && waited < kPatience; waited += kPause) std::this_thread::sleep_for(kPause);
  if (ends_->done) {
    thread_.join();
  } else {
    thread_.detach();
  }
}

void StderrRelay::pass_on(Ends& ends) noexcept {
  std::array<char, 4096> part{};
  for (ssize_t got = 0; (got = ::read(ends.pipe.get(), part.data(), part.size())) > 0;) {
    const char* next = part.data();
    while (got > 0) {
      const ssize_t taken = ::write(ends.out.get(), next, static_cast<std::size_t>(got));
      if (taken < 0 && errno == EAGAIN) {  // another end of the same terminal was set not to block
        pollfd ready{.fd = ends.out.get(), .events = POLLOUT, .revents = 0};
        ::poll(&ready, 1, -1);
      } else if (taken < 0 && errno != EINTR) {
        break;  // its reader is gone: the rest goes nowhere
      } else if (taken > 0) {
        next += taken, got -= taken;
      }
    }
  }
  ends.done = true;
}

void remark(const std::string& text) {
  const std::uint64_t lost = lines_lost.exchange(0);
  const std::string before = lost > 0 ? "(" + std::to_string(lost) + " lines were lost) " : "";
  if (std::fprintf(stderr, "jaywalk: %s%s\n", before.c_str(), text.c_str()) < 0) lines_lost += lost + 1;
}

}  // namespace jaywalk
