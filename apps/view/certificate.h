#pragma once
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

}  // namespace jaywalk::view
