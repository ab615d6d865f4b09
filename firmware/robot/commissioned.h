#pragma once
// What a commissioning run found, kept beside the robot file: ROBOT.commissioned.json.
#include <filesystem>
#include <string>
#include <vector>

#include "firmware/robot/preflight.h"
#include "firmware/robot/robot_file.h"

namespace jaywalk {

enum class Commissioned { kNotYet, kChangedSince, kFailed, kPassed };

struct CommissioningRecord {
  Commissioned state = Commissioned::kNotYet;
  std::string date;  ///< of the run, UTC; empty where there was none
  std::string said;  ///< a sentence for a person, with what to do where it is not kPassed
};

/// "mine.commissioned.json" for "mine.toml".
[[nodiscard]] std::filesystem::path commissioned_path(const std::filesystem::path& robot);

/// A number that another drive, scale, node, wheel, track, scanner or mount changes (FNV-1a, hexadecimal).
[[nodiscard]] std::string wiring_digest(const RobotFile& file);

/// The old record is replaced whole, or stays where the new one cannot be written. Throws StartupError there.
void write_commissioned(const std::filesystem::path& robot, const RobotFile& file,
                        const std::vector<CheckedPart>& checks);

/// Before the wheels turn: what was found before holds no longer, and counts as failed until write_commissioned().
/// Throws StartupError where it cannot be written.
void withdraw_commissioned(const std::filesystem::path& robot, const RobotFile& file);

/// A file that cannot be read counts as never; one that is of other wiring as changed.
[[nodiscard]] CommissioningRecord read_commissioned(const std::filesystem::path& robot, const RobotFile& file);

/// For `jaywalk run`: a remark, empty where all is well. Throws StartupError where commissioning failed, and where
/// there was none of this wiring unless a person takes it upon themselves (`uncommissioned`).
[[nodiscard]] std::string require_commissioned(const std::filesystem::path& robot, const RobotFile& file,
                                               bool uncommissioned);

}  // namespace jaywalk
