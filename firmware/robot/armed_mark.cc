#include "firmware/robot/armed_mark.h"

#include <fstream>
#include <system_error>

#include "hal/types/errors.h"

namespace jaywalk {

ArmedMark::ArmedMark(const std::filesystem::path& control_socket)
    : file_(control_socket.string() + ".armed"), was_left_(std::filesystem::exists(file_)) {}

ArmedMark::~ArmedMark() {
  std::error_code ignored;
  if (set_) std::filesystem::remove(file_, ignored);
}

void ArmedMark::set() {
  std::ofstream file(file_);
  file << "The drives are armed.\n";
  if (!file.flush())
    throw StartupError(file_.string() + ": cannot be written", "make its folder writable for this user");
  set_ = true;
}

}  // namespace jaywalk
