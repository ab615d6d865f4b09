#pragma once
// Secrets of the live page: certificate, token, and the file that holds its address.
#include <boost/asio/ssl/context.hpp>
#include <filesystem>
#include <memory>
#include <string>

namespace jaywalk::view {
/// TLS 1.2 or later with the certificate and key of a PEM file. `given` empty: jaywalk/view.pem in the user's state
/// folder
/// ($XDG_STATE_HOME, ~/.local/state), self-signed, made at the first start, mode 0600. Throws StartupError where
/// that cannot be read or made.
[[nodiscard]] std::shared_ptr<boost::asio::ssl::context> tls_context(const std::filesystem::path& given);

/// SHA-256 of a certificate as browsers show it: "AB:CD:...".
[[nodiscard]] std::string fingerprint_of(const X509* certificate);

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
