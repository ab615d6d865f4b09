#include "apps/view/certificate.h"

#include <fcntl.h>
#include <openssl/pem.h>
#include <openssl/rand.h>
#include <openssl/x509.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "drivers/wire/file_descriptor.h"
#include "hal/types/errors.h"

namespace jaywalk::view {
namespace {

namespace ssl = boost::asio::ssl;
using Path = std::filesystem::path;
template <class T>
using Owned = std::unique_ptr<T, void (*)(T*)>;

constexpr long kValid_s = 10L * 365 * 24 * 3600;  ///< it is known by its fingerprint: the years say nothing
constexpr const char* kRemedy = "give a PEM file with certificate and key by --view-certificate";

Path state_folder() {
  const char* const state = std::getenv("XDG_STATE_HOME");
  const char* const home = std::getenv("HOME");
  if (state != nullptr && *state == '/') return Path(state) / "jaywalk";
  if (home != nullptr && *home == '/') return Path(home) / ".local/state/jaywalk";
  throw StartupError("no folder for the live page's certificate: neither HOME nor XDG_STATE_HOME is set", kRemedy);
}

/// Key and certificate, self-signed, P-256.
std::string made_pem() {
  const Owned<EVP_PKEY> key(::EVP_EC_gen("P-256"), &::EVP_PKEY_free);
  const Owned<X509> made(::X509_new(), &::X509_free);
  const Owned<BIO> text(::BIO_new(::BIO_s_mem()), [](BIO* bio) { ::BIO_free(bio); });
  std::array<unsigned char, 8> serial{};
  bool sound = key && made && text && ::RAND_bytes(serial.data(), serial.size()) == 1;
  if (sound) {
    X509_NAME* const name = ::X509_get_subject_name(made.get());
    const Owned<BIGNUM> number(::BN_bin2bn(serial.data(), serial.size(), nullptr), &::BN_free);
    sound = ::X509_set_version(made.get(), 2) == 1 &&
            ::BN_to_ASN1_INTEGER(number.get(), ::X509_get_serialNumber(made.get())) != nullptr &&
            ::X509_gmtime_adj(::X509_getm_notBefore(made.get()), 0) != nullptr &&
            ::X509_gmtime_adj(::X509_getm_notAfter(made.get()), kValid_s) != nullptr &&
            ::X509_NAME_add_entry_by_txt(name, "CN", MBSTRING_ASC,
                                         reinterpret_cast<const unsigned char*>("jaywalk live page"), -1, -1, 0) == 1 &&
            ::X509_set_issuer_name(made.get(), name) == 1 && ::X509_set_pubkey(made.get(), key.get()) == 1 &&
            ::X509_sign(made.get(), key.get(), ::EVP_sha256()) > 0 &&
            ::PEM_write_bio_PrivateKey(text.get(), key.get(), nullptr, nullptr, 0, nullptr, nullptr) == 1 &&
            ::PEM_write_bio_X509(text.get(), made.get()) == 1;
  }
  if (!sound) throw StartupError("no certificate could be made for the live page", kRemedy);
  char* bytes = nullptr;
  const long size = BIO_get_mem_data(text.get(), &bytes);
  return {bytes, static_cast<std::size_t>(size)};
}

[[noreturn]] void failed(const Path& path, const std::string& cause) {
  throw StartupError(path.string() + ": " + cause, kRemedy);
}

/// Whole or not at all; where another start was quicker, its file stays.
void make(const Path& path) {
  const std::string pem = made_pem();
  std::error_code error;
  std::filesystem::create_directories(path.parent_path(), error);
  ::chmod(path.parent_path().c_str(), S_IRWXU);
  std::string draft = path.string() + ".XXXXXX";
  const wire::FileDescriptor file(::mkostemp(draft.data(), O_CLOEXEC));  // mode 0600
  if (file.get() < 0) failed(path, std::strerror(errno));
  const bool written = ::write(file.get(), pem.data(), pem.size()) == static_cast<ssize_t>(pem.size());
  const bool linked = written && (::link(draft.c_str(), path.c_str()) == 0 || errno == EEXIST);
  const int cause = errno;
  ::unlink(draft.c_str());
  if (!linked) failed(path, std::strerror(cause));
}

std::string read_whole(const Path& path, int flags) {
  const wire::FileDescriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | flags));
  std::string text(1U << 16U, '\0');
  const ssize_t got = file.get() < 0 ? -1 : ::read(file.get(), text.data(), text.size());
  if (got < 0) failed(path, std::strerror(errno));
  return text.substr(0, static_cast<std::size_t>(got));
}

}  // namespace

std::shared_ptr<ssl::context> tls_context(const Path& own) {
  const Path path = own.empty() ? state_folder() / "view.pem" : own;
  if (own.empty() && !std::filesystem::exists(std::filesystem::symlink_status(path))) make(path);
  const std::string pem = read_whole(path, own.empty() ? O_NOFOLLOW : 0);
  auto context = std::make_shared<ssl::context>(ssl::context::tls_server);
  try {
    context->set_options(ssl::context::default_workarounds | ssl::context::no_tlsv1 | ssl::context::no_tlsv1_1);
    context->use_certificate_chain(boost::asio::buffer(pem));
    context->use_private_key(boost::asio::buffer(pem), ssl::context::pem);
  } catch (const boost::system::system_error& error) {
    failed(path, "no certificate and its key: " + error.code().message());
  }
  return context;
}

std::string fingerprint_of(const X509* certificate) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> bytes{};
  unsigned count = 0;
  ::X509_digest(certificate, ::EVP_sha256(), bytes.data(), &count);
  std::string text;
  for (unsigned k = 0; k < count; ++k) {
    char two[4];
    std::snprintf(two, sizeof two, "%s%02X", k == 0 ? "" : ":", bytes[k]);
    text += two;
  }
  return text;
}

}  // namespace jaywalk::view
