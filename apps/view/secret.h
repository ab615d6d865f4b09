#pragma once
#include <filesystem>
#include <string>

namespace jaywalk::view {

/// 128 random bits in hexadecimal. Throws StartupError where the system has none.
[[nodiscard]] std::string made_token();

/// A page's address with its token in a file beside the control socket, NAME.view, for those who may use that: readable
/// by its owner and group. Removed at the end.
class AddressFile {
 public:
  /// Throws StartupError where it cannot be written, or another program's file has its name.
  AddressFile(const std::filesystem::path& control_socket, std::string url);
  ~AddressFile();
  AddressFile(const AddressFile&) = delete;
  AddressFile& operator=(const AddressFile&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }

 private:
  std::filesystem::path path_;
  std::string url_;
};

}  // namespace jaywalk::view
