#include "apps/campaign/campaign_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <fstream>
#include <vector>

#include "hal/text_file.h"

namespace jaywalk::campaign {
namespace {

constexpr std::array kKeptOfAll{"run.json", "summary.json", "run.svg"};

/// The file lock that a process has until it ends, however it ends.
int hold(const std::filesystem::path& file, const std::string& share) {
  const int held = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (held < 0) throw StartupError(file.string() + ": cannot be written", "give --out a folder that can be written");
  if (::flock(held, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return held;  // not every disk has locks
  ::close(held);
  throw StartupError(file.parent_path().string() + ": another process runs its share " + share,
                     "wait for its end, or choose another --shard");
}

void make_folders(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw StartupError(folder.string() + ": " + error.message(), "give --out a folder that can be written");
}

void prune(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> others;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (std::find(kKeptOfAll.begin(), kKeptOfAll.end(), name) == kKeptOfAll.end()) others.push_back(entry.path());
  }
  for (const std::filesystem::path& other : others) std::filesystem::remove_all(other);
}

}  // namespace

void write_whole(const std::filesystem::path& file, const std::string& text, const std::string& own_name) {
  const std::filesystem::path begun = file.string() + "." + own_name;
  std::ofstream out(begun, std::ios::binary | std::ios::trunc);
  out << text;
  out.close();
  std::error_code error;
  if (out) std::filesystem::rename(begun, file, error);
  if (!out || error) throw StartupError(file.string() + ": cannot be written", "free some disk and call this again");
}

std::filesystem::path place_of(const std::filesystem::path& campaign, const PlannedRun& run) {
  return campaign / "runs" / run.folder;
}

CampaignFolder::CampaignFolder(const std::filesystem::path& path, const std::string& text, const Shard& shard)
    : path_(path), share_(std::to_string(shard.part) + "-of-" + std::to_string(shard.of)) {
  make_folders(path_ / "shares");
  held_ = hold(path_ / "shares" / share_, share_);
  const std::filesystem::path plan = path_ / "campaign.json";
  if (!std::filesystem::exists(plan)) write_whole(plan, text, share_);
  if (text_in(plan) == text) return;
  ::close(held_);
  throw StartupError(path.string() + ": holds another campaign, or runs of other scenarios or of another build",
                     "choose another --out, or remove it");
}

CampaignFolder::~CampaignFolder() { ::close(held_); }

std::filesystem::path CampaignFolder::work(const PlannedRun& run) const {
  return place_of(path_, run).string() + ".part-" + share_;
}

bool CampaignFolder::is_finished(const PlannedRun& run) const {
  return std::filesystem::exists(place_of(path_, run) / "run.json");
}

RunResult CampaignFolder::result(const PlannedRun& run) const { return read_result(place_of(path_, run) / "run.json"); }

std::filesystem::path CampaignFolder::begin(const PlannedRun& run) const {
  drop(run);
  make_folders(work(run));
  return work(run);
}

void CampaignFolder::drop(const PlannedRun& run) const {
  std::error_code ignored;
  std::filesystem::remove_all(work(run), ignored);
}

void CampaignFolder::finish(const PlannedRun& run, const RunResult& result, Keep keep) const {
  if (keep == Keep::kFigures || (keep == Keep::kFailures && result.success)) prune(work(run));
  write_whole(work(run) / "run.json", to_text(result), share_);
  std::error_code error;
  std::filesystem::rename(work(run), place_of(path_, run), error);
  if (!error) return;
  if (!is_finished(run)) throw StartupError(place_of(path_, run).string() + ": " + error.message(), "remove it");
  drop(run);  // another division of the campaign finished it, with the same result
}

}  // namespace jaywalk::campaign
