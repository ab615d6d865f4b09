#include "apps/campaign/run_pool.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <utility>

#include "hal/types/errors.h"

namespace jaywalk::campaign {
namespace {

constexpr int kNotStarted = 127;

/// Between fork and exec: nothing here allocates.
[[noreturn]] void become(const char* program, const char* folder, const char* said, char* const* words, pid_t parent) {
  ::setpgid(0, 0);  // Ctrl-C is for the campaign, which then ends its runs
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent || ::chdir(folder) != 0) ::_exit(kNotStarted);
  const int file = ::open(said, O_WRONLY | O_CREAT | O_TRUNC, 0644);
  if (file < 0 || ::dup2(file, STDOUT_FILENO) < 0 || ::dup2(file, STDERR_FILENO) < 0) ::_exit(kNotStarted);
  ::execv(program, words);
  ::_exit(kNotStarted);
}

}  // namespace

RunPool::RunPool(std::filesystem::path program, std::filesystem::path folder)
    : program_(std::move(program)), folder_(std::move(folder)) {}

RunPool::~RunPool() { kill_all(); }

void RunPool::start(std::size_t index, const PlannedRun& run, const std::filesystem::path& out) {
  const std::string said = (out / "said.txt").string();
  std::vector<std::string> words{program_.string()};
  words.insert(words.end(), run.arguments.begin(), run.arguments.end());
  words.insert(words.end(), {"--out", out.string()});
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  const pid_t parent = ::getpid();
  const pid_t child = ::fork();
  if (child == 0) become(program_.c_str(), folder_.c_str(), said.c_str(), pointers.data(), parent);
  if (child < 0) throw StartupError(std::string("no process for a run: ") + std::strerror(errno), "give fewer --jobs");
  runs_[child] = index;
}

std::optional<RunPool::Ended> RunPool::ended() {
  for (auto run = runs_.begin(); run != runs_.end(); ++run) {
    int status = 0;
    if (::waitpid(run->first, &status, WNOHANG) != run->first) continue;
    const Ended ended{run->second, status};
    runs_.erase(run);
    return ended;
  }
  return std::nullopt;
}

std::vector<std::size_t> RunPool::kill_all() {
  std::vector<std::size_t> killed;
  for (const auto& [process, index] : runs_) {
    ::kill(process, SIGKILL);
    ::waitpid(process, nullptr, 0);
    killed.push_back(index);
  }
  runs_.clear();
  return killed;
}

}  // namespace jaywalk::campaign
