#pragma once
#include <string>

namespace jaywalk {

/// What came of a recording that was lived through again.
struct Relived {
  int ticks = 0;
  int different = 0;  ///< commands that differ from the recorded ones in any bit
};

/// Ticks a new controller through the recording `file`, which is removed afterwards.
Relived relive(const std::string& file);

}  // namespace jaywalk
