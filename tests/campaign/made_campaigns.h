#pragma once
// A folder for a test's own files.
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace jaywalk::campaign {

/// Empty at first, removed at the end.
class CampaignScratch {
 public:
  CampaignScratch()
      : path_(std::filesystem::temp_directory_path() / ("jaywalk_campaign_" + std::to_string(::getpid()))) {
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~CampaignScratch() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  CampaignScratch(const CampaignScratch&) = delete;
  CampaignScratch& operator=(const CampaignScratch&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    const std::filesystem::path file = path_ / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << text;
    return file;
  }

 private:
  std::filesystem::path path_;
};

/// What `call` is refused with; empty where it is not.
template <class Call>
std::string refusal_of(const Call& call) {
  try {
    call();
  } catch (const std::exception& e) {
    return e.what();
  }
  return "";
}

inline bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace jaywalk::campaign
