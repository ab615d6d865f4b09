#pragma once
// Many runs as one experiment: what a campaign file says, and the runs that it comes to.
#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "hal/setting_keys.h"
#include "hal/toml_file.h"
#include "hal/types/geometry.h"

namespace jaywalk::campaign {

/// One thing that is varied: a key of the scenario ("movers.count"), or an option ("mode").
struct Axis : ListedKey {
  bool is_option = false;  ///< of jaywalk sim, not a key of the scenario
};

/// Every scenario with every seed, for each combination of the axes' values.
struct Experiment {
  std::string name;                                              ///< of its folder, too
  std::string title;                                             ///< for the report
  std::vector<std::string> scenarios;                            ///< as the file has them: relative to its folder
  std::optional<std::pair<std::uint64_t, std::uint64_t>> seeds;  ///< first, last; without them each scenario's own
  bool constant_speed = false;
  std::vector<Axis> axes;  ///< the first changes slowest
  std::string place;       ///< "paper.toml:3: "
};

/// What of a run's folder is kept: figures alone; those, and everything of runs that failed; everything.
enum class Keep { kFigures, kFailures, kAll };

struct Campaign {
  std::filesystem::path file;
  std::string title;
  Keep keep = Keep::kFailures;
  std::vector<Experiment> experiments;
};

/// Its keys (hal/setting_keys.h).
[[nodiscard]] const FileKeys& campaign_keys();

/// Throws StartupError "FILE:LINE: cause; remedy" for anything wrong with the file itself; plan_of judges what it
/// says about scenarios.
[[nodiscard]] Campaign load_campaign(const std::filesystem::path& file);

/// One run of a campaign.
struct PlannedRun {
  std::string row;  ///< the values of the axes that vary, in words: "movers.count 16, mode paper"; else "all"
  std::vector<std::string> values;  ///< of the experiment's axes
  std::string scenario;             ///< the file's name without its end
  std::uint64_t seed = 0;
  std::string folder;                  ///< below the campaign's: "movers/movers.count=16/map1_16/101"
  std::vector<std::string> arguments;  ///< of jaywalk in the campaign file's folder, without --out
  std::string command = {};            ///< "jaywalk sim ... --out DIR": repeats it, in the campaign file's folder
  Vec2 goal;                           ///< in the map, m
  double cruise_mps = 0.0;             ///< the robot's greatest speed
};

struct Plan {
  std::vector<PlannedRun> runs;
  std::set<std::filesystem::path> inputs;  ///< scenarios, maps, recordings of movers
};

/// All runs in their fixed order: experiments as the file has them, then axes, then scenarios, then seeds. Each
/// scenario is read with each combination of settings: throws StartupError, with the campaign file's place, for one
/// that is refused, and where two runs would have the same folder.
[[nodiscard]] Plan plan_of(const Campaign& campaign);

/// Runs, each a process of its own, so that one that crashes takes no other with it. They end with this process,
/// however it ends. Thread: the one that made it.
class RunPool {
 public:
  struct Ended {
    std::size_t run = 0;
    int status = 0;  ///< waitpid's
  };

  /// `program`: jaywalk; `folder`: where its arguments' paths begin.
  RunPool(std::filesystem::path program, std::filesystem::path folder)
      : program_(std::move(program)), folder_(std::move(folder)) {}
  ~RunPool() { kill_all(); }
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
