#include "apps/formats/byte_file.h"

#include <utility>

#include "hal/text_file.h"
#include "hal/types/errors.h"

namespace jaywalk::exchange {

ByteFile::ByteFile(const std::filesystem::path& file, std::string remedy)
    : file_(file), remedy_(std::move(remedy)), in_(file, std::ios::binary) {
  require_readable(file, name() + ": ", "give a recording");
  size_ = std::filesystem::file_size(file);
}

std::string ByteFile::read(std::uint64_t at, std::uint64_t bytes) {
  if (bytes > kMostRecordBytes) refuse(at, "a record of " + std::to_string(bytes) + " bytes");
  if (at > size_ || bytes > size_ - at) refuse(at, "the file ends before what begins here");
  std::string out(bytes, '\0');
  in_.seekg(static_cast<std::streamoff>(at));
  in_.read(out.data(), static_cast<std::streamsize>(bytes));
  if (!in_) refuse(at, "cannot be read");
  return out;
}

void ByteFile::refuse(std::uint64_t at, const std::string& cause) const {
  throw StartupError(name() + ": byte " + std::to_string(at) + ": " + cause, remedy_);
}

}  // namespace jaywalk::exchange
