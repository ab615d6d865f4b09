#include "apps/view/secret.h"

#include <fcntl.h>
#include <openssl/crypto.h>
#include <openssl/pem.h>
#include <openssl/rand.h>
#include <openssl/x509.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>

#include "drivers/wire/file_descriptor.h"
#include "hal/shown_text.h"
#include "hal/types/errors.h"

namespace jaywalk::view {
namespace {
namespace ssl = boost::asio::ssl;
template <class T, class End>
using Owned = std::unique_ptr<T, End*>;

constexpr long kValid_s = 10L * 365 * 24 * 3600;  ///< it is known by its fingerprint: the years say nothing
constexpr const char* kRemedy = "give a PEM file with certificate and key by --view-certificate";

std::filesystem::path state_folder() {
  const char* const state = std::getenv("XDG_STATE_HOME");
  const char* const home = std::getenv("HOME");
  if (state != nullptr && *state == '/') return std::filesystem::path(state) / "jaywalk";
  if (home != nullptr && *home == '/') return std::filesystem::path(home) / ".local/state/jaywalk";
  throw StartupError("no folder for the live page's certificate: neither HOME nor XDG_STATE_HOME is set", kRemedy);
}

/// Key and certificate, self-signed, P-256. False: it could not be written.
bool write_pem(std::FILE* file) {
  const Owned<EVP_PKEY, decltype(::EVP_PKEY_free)> key(::EVP_EC_gen("P-256"), &::EVP_PKEY_free);
  const Owned<X509, decltype(::X509_free)> made(::X509_new(), &::X509_free);
  std::int64_t serial = 0;  // browsers want another one for another key of the same name
  if (!key || !made || ::RAND_bytes(reinterpret_cast<unsigned char*>(&serial), sizeof serial - 1) != 1) return false;
  X509_NAME* const name = ::X509_get_subject_name(made.get());
  const auto* const words = reinterpret_cast<const unsigned char*>("jaywalk live page");
  return ::X509_set_version(made.get(), X509_VERSION_3) == 1 &&
         ::ASN1_INTEGER_set_int64(::X509_get_serialNumber(made.get()), serial) == 1 &&
         ::X509_gmtime_adj(::X509_getm_notBefore(made.get()), 0) != nullptr &&
         ::X509_gmtime_adj(::X509_getm_notAfter(made.get()), kValid_s) != nullptr &&
         ::X509_NAME_add_entry_by_txt(name, "CN", MBSTRING_ASC, words, -1, -1, 0) == 1 &&
         ::X509_set_issuer_name(made.get(), name) == 1 && ::X509_set_pubkey(made.get(), key.get()) == 1 &&
         ::X509_sign(made.get(), key.get(), ::EVP_sha256()) > 0 &&
         ::PEM_write_PrivateKey(file, key.get(), nullptr, nullptr, 0, nullptr, nullptr) == 1 &&
         ::PEM_write_X509(file, made.get()) == 1 && std::fflush(file) == 0;
}

/// Whole or not at all; where another start was quicker, its file stays.
void make(const std::filesystem::path& path) {
  std::error_code error;
  std::filesystem::create_directories(path.parent_path(), error);
  ::chmod(path.parent_path().c_str(), S_IRWXU);
  std::string draft = path.string() + ".XXXXXX";
  const int made = ::mkstemp(draft.data());  // mode 0600
  const Owned<std::FILE, decltype(::fclose)> file(made < 0 ? nullptr : ::fdopen(made, "w"), &::fclose);
  if (!file || !write_pem(file.get())) throw StartupError(path.string() + ": cannot be made", kRemedy);
  static_cast<void>(::link(draft.c_str(), path.c_str()));
  ::unlink(draft.c_str());
}

}  // namespace

std::shared_ptr<ssl::context> tls_context(const std::filesystem::path& given) {
  const std::filesystem::path path = given.empty() ? state_folder() / "view.pem" : given;
  if (given.empty() && !std::filesystem::exists(std::filesystem::symlink_status(path))) make(path);
  auto context = std::make_shared<ssl::context>(ssl::context::tls_server);
  try {
    context->set_options(ssl::context::default_workarounds | ssl::context::no_tlsv1 | ssl::context::no_tlsv1_1);
    context->use_certificate_chain_file(path.string());
    context->use_private_key_file(path.string(), ssl::context::pem);
  } catch (const boost::system::system_error& error) {
    throw StartupError(path.string() + ": no certificate and its key: " + error.code().message(), kRemedy);
  }
  return context;
}

std::string fingerprint_of(const X509* certificate) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> bytes{};
  std::array<char, 3 * EVP_MAX_MD_SIZE> text{};
  unsigned count = 0;
  ::X509_digest(certificate, ::EVP_sha256(), bytes.data(), &count);
  ::OPENSSL_buf2hexstr_ex(text.data(), text.size(), nullptr, bytes.data(), count, ':');
  return text.data();
}

std::string made_token() {
  std::array<std::uint64_t, 2> bits{};
  if (::RAND_bytes(reinterpret_cast<unsigned char*>(bits.data()), sizeof bits) != 1)
    throw StartupError("no random numbers for the page's token", "see that the system's random numbers work");
  return formatted("%016lx%016lx", bits[0], bits[1]);
}

AddressFile::AddressFile(const std::filesystem::path& control_socket, const std::string& url)
    : path_(control_socket.string() + ".view") {
  std::string before;
  if (std::filesystem::is_regular_file(std::filesystem::symlink_status(path_)))
    std::getline(std::ifstream(path_), before);
  if (before.starts_with("http") && before.find("/?token=") != std::string::npos)
    ::unlink(path_.c_str());  // of a run that was killed
  const wire::FileDescriptor file(::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0600));
  const std::string line = url + "\n";
  if (file.get() < 0 || ::fchmod(file.get(), S_IRUSR | S_IWUSR | S_IRGRP) != 0 ||
      ::write(file.get(), line.data(), line.size()) != static_cast<ssize_t>(line.size()))
    throw StartupError(path_.string() + ": " + std::strerror(errno),
                       "move away what has that name, or give control_socket another one, in a folder of yours");
}

AddressFile::~AddressFile() { ::unlink(path_.c_str()); }

}  // namespace jaywalk::view
