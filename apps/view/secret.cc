#include "apps/view/secret.h"

#include <fcntl.h>
#include <openssl/rand.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>

#include "drivers/wire/file_descriptor.h"
#include "hal/types/errors.h"

namespace jaywalk::view {

std::string made_token() {
  std::array<unsigned char, 16> bytes{};
  if (::RAND_bytes(bytes.data(), bytes.size()) != 1)
    throw StartupError("no random numbers for the page's token", "see that the system's random numbers work");
  std::string token;
  for (const unsigned char byte : bytes)
    token += "0123456789abcdef"[byte >> 4U], token += "0123456789abcdef"[byte & 15U];
  return token;
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
