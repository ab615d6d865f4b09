#pragma once

namespace jaywalk {

/// Whatever is opened first takes the number of a standard stream that was closed, a recording or a bus, and is written
/// to by what writes to that: gives such numbers to /dev/null. To be called before anything is opened.
void open_standard_streams();

/// Throws StartupError when standard output did not take all that was said there, as on a full disk.
void require_heard();

}  // namespace jaywalk
