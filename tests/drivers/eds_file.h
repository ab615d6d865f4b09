#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "drivers/canopen/cia402.h"

namespace jaywalk::canopen {

/// What an electronic data sheet says about one object.
struct ObjectEntry {
  std::string name;
  std::string access;  ///< "ro", "rw", "wo", "const", "rwr", "rww"; empty for the head of an array
  int line = 0;        ///< where its section begins

  [[nodiscard]] bool is_writable() const { return access.starts_with("rw") || access == "wo"; }
  [[nodiscard]] bool is_readable() const { return !access.empty() && access != "wo"; }
};

/// A drive's object dictionary as its maker's EDS file tells it (CiA 306: sections "[6040]", "[1016sub1]").
class EdsFile {
 public:
  /// Throws StartupError "FILE:LINE: cause; remedy" for what cannot be read or is no EDS. Start-up only.
  explicit EdsFile(const std::filesystem::path& file);

  /// Null where the file does not have it.
  [[nodiscard]] const ObjectEntry* find(ObjectAddress address) const;
  [[nodiscard]] std::size_t size() const { return objects_.size(); }

 private:
  std::map<ObjectAddress, ObjectEntry> objects_;
};

struct NeededObject {
  ObjectAddress address;
  bool writable = false;
  const char* what_for = "";
};

/// What a drive lacks: for being driven in profile velocity, and for the arming proof that it stops by itself when
/// the controller falls silent (written and read back at arming).
struct DriveShortcomings {
  std::vector<NeededObject> for_driving;
  std::vector<NeededObject> for_proof;
  /// There, but read-only: arming can only see whether what stands there will do.
  std::vector<NeededObject> fixed_for_proof;
};

[[nodiscard]] DriveShortcomings shortcomings(const EdsFile& eds);

}  // namespace jaywalk::canopen
