#include "apps/view/secret.h"

#include <fcntl.h>
#include <openssl/rand.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <optional>

#include "drivers/wire/file_descriptor.h"
#include "hal/types/errors.h"

namespace jaywalk::view {
namespace {

/// What a regular file of this user begins with; a link is none. Empty where there is no file.
std::optional<std::string> own_text(const std::filesystem::path& path) {
  const wire::FileDescriptor file(::open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
  if (file.get() < 0) return errno == ENOENT ? std::optional<std::string>("") : std::nullopt;
  struct stat kind {};
  std::array<char, 512> text{};
  if (::fstat(file.get(), &kind) != 0 || !S_ISREG(kind.st_mode) || kind.st_uid != ::geteuid()) return std::nullopt;
  const ssize_t got = ::read(file.get(), text.data(), text.size());
  return got < 0 ? std::nullopt : std::optional<std::string>(std::in_place, text.data(), static_cast<std::size_t>(got));
}

bool is_address(const std::string& text) {
  return text.empty() || (text.starts_with("http") && text.find("/?token=") != std::string::npos);
}

}  // namespace

std::string made_token() {
  std::array<unsigned char, 16> bytes{};
  if (::RAND_bytes(bytes.data(), bytes.size()) != 1)
    throw StartupError("no random numbers for the page's token", "see that the system's random numbers work");
  std::string token;
  for (const unsigned char byte : bytes)
    token += "0123456789abcdef"[byte >> 4U], token += "0123456789abcdef"[byte & 15U];
  return token;
}

AddressFile::AddressFile(const std::filesystem::path& control_socket, std::string url)
    : path_(control_socket.string() + ".view"), url_(std::move(url) + "\n") {
  const auto before = own_text(path_);
  if (!before || !is_address(*before))
    throw StartupError(path_.string() + ": not written by a run, or another user's: it stays as it is",
                       "move it away, or give control_socket another name");
  std::string draft = path_.string() + ".XXXXXX";
  const wire::FileDescriptor file(::mkostemp(draft.data(), O_CLOEXEC));
  const auto size = static_cast<ssize_t>(url_.size());
  if (file.get() < 0 || ::fchmod(file.get(), S_IRUSR | S_IWUSR | S_IRGRP) != 0 ||
      ::write(file.get(), url_.data(), url_.size()) != size || ::rename(draft.c_str(), path_.c_str()) != 0) {
    const std::string cause = std::strerror(errno);
    if (file.get() >= 0) ::unlink(draft.c_str());
    throw StartupError(path_.string() + ": " + cause, "give control_socket a folder in which files can be made");
  }
}

AddressFile::~AddressFile() {
  if (own_text(path_) == url_) ::unlink(path_.c_str());
}

}  // namespace jaywalk::view
