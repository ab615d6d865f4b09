#pragma once
#include <sys/types.h>

#include <filesystem>
#include <map>
#include <optional>
#include <vector>

#include "apps/campaign/campaign.h"

namespace jaywalk::campaign {

/// Runs, each a process of its own, so that one that crashes takes no other with it. They end with this process,
/// however it ends. Thread: the one that made it.
class RunPool {
 public:
  struct Ended {
    std::size_t run = 0;
    int status = 0;  ///< waitpid's
  };

  /// `program`: jaywalk; `folder`: where its arguments' paths begin.
  RunPool(std::filesystem::path program, std::filesystem::path folder);
  ~RunPool();
  RunPool(const RunPool&) = delete;
  RunPool& operator=(const RunPool&) = delete;

  /// `out` is the run's folder, and holds what it says in said.txt. Throws StartupError where there is no process to be
  /// had.
  void start(std::size_t index, const PlannedRun& run, const std::filesystem::path& out);
  [[nodiscard]] std::size_t size() const { return runs_.size(); }
  /// One that has ended since; nothing where none has.
  [[nodiscard]] std::optional<Ended> ended();
  /// Ends those that still run. Returns which they were.
  std::vector<std::size_t> kill_all();

 private:
  std::filesystem::path program_, folder_;
  std::map<pid_t, std::size_t> runs_;
};

}  // namespace jaywalk::campaign
