#include "firmware/program/standard_streams.h"

#include <fcntl.h>
#include <unistd.h>

#include <cstdio>

#include "hal/types/errors.h"

namespace jaywalk {

void open_standard_streams() {
  int file = 0;
  do file = ::open("/dev/null", O_RDWR);
  while (file >= 0 && file <= STDERR_FILENO);
  if (file > STDERR_FILENO) ::close(file);
}

void require_heard() {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return;
  throw StartupError("standard output: not all of it was taken", "free some space where it goes");
}

}  // namespace jaywalk
