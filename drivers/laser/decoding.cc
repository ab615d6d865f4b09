#include "drivers/laser/decoding.h"

namespace jaywalk {

std::string_view name(Decoding decoding) noexcept {
  switch (decoding) {
    case Decoding::kScan:
      return "scan";
    case Decoding::kOtherMessage:
      return "another message";
    case Decoding::kTruncated:
      return "cut off";
    case Decoding::kChecksum:
      return "wrong checksum";
    case Decoding::kBadField:
      return "bad field";
    case Decoding::kTooManyBeams:
      return "too many beams";
    case Decoding::kNoDistances:
      return "no distances";
    case Decoding::kDeviceError:
      return "scanner reports an error";
    case Decoding::kDirty:
      return "scanner's window is dirty";
  }
  return "unknown";
}

}  // namespace jaywalk
