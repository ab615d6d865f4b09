#pragma once
// Settings given beside a file, "movers.count=16", in place of the file's own. Start-up only.
#include <filesystem>
#include <string>
#include <toml.hpp>

#include "hal/setting_keys.h"

namespace jaywalk {

/// What the place of a value begins with that no file holds.
inline constexpr const char* kGivenPlace = "--set ";

/// Puts `setting`, KEY=VALUE, into the parsed file `root`: KEY is a path of `keys`; VALUE is true, false, a number,
/// numbers with commas between them, or else a text. A key of tables written as [[movers]] is put into each of them
/// that may hold it; tables that are missing are made. A file's name is relative to the working folder. Throws
/// StartupError for what is no KEY=VALUE, an unknown key, or a list without a table that may hold it; range and kind of
/// the value are the parser's to judge.
void apply_setting(toml::value& root, const FileKeys& keys, const std::filesystem::path& file,
                   const std::string& setting);

}  // namespace jaywalk
