#pragma once
#include <filesystem>
#include <string>

namespace jaywalk::view {

/// 128 random bits in hexadecimal. Throws StartupError where the system has none.
[[nodiscard]] std::string made_token();

/// A file beside the control socket, NAME.view, that holds the page's address with its token. Owner and group can read
/// it (mode 0640), as they can use the socket. The run's end removes it.
class AddressFile {
 public:
  /// Throws StartupError where it cannot be made, or its name is taken by what no run wrote.
  AddressFile(const std::filesystem::path& control_socket, const std::string& url);
  ~AddressFile();
  AddressFile(const AddressFile&) = delete;
  AddressFile& operator=(const AddressFile&) = delete;

 private:
  std::filesystem::path path_;
};

}  // namespace jaywalk::view
