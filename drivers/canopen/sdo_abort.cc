#include "drivers/canopen/sdo_abort.h"

#include <algorithm>
#include <array>

namespace jaywalk::canopen {

namespace {

struct Reason {
  std::uint32_t code;
  std::string_view name;
};

constexpr std::array kReasons{
    Reason{0x05030000, "toggle bit did not alternate"},
    Reason{0x05040000, "no answer in time"},
    Reason{0x05040001, "unknown command"},
    Reason{0x05040002, "bad block size"},
    Reason{0x05040003, "bad sequence number"},
    Reason{0x05040004, "checksum error"},
    Reason{0x05040005, "out of memory"},
    Reason{0x06010000, "access not supported"},
    Reason{0x06010001, "write only"},
    Reason{0x06010002, "read only"},
    Reason{0x06020000, "no such object"},
    Reason{0x06040041, "cannot be mapped to a PDO"},
    Reason{0x06040042, "mapping longer than a PDO"},
    Reason{0x06040043, "incompatible parameters"},
    Reason{0x06040047, "incompatible inside the device"},
    Reason{0x06060000, "hardware error"},
    Reason{0x06070010, "length does not match"},
    Reason{0x06070012, "too long"},
    Reason{0x06070013, "too short"},
    Reason{0x06090011, "no such sub-index"},
    Reason{0x06090030, "value out of range"},
    Reason{0x06090031, "value too high"},
    Reason{0x06090032, "value too low"},
    Reason{0x06090036, "maximum below minimum"},
    Reason{0x060A0023, "resource not available"},
    Reason{0x08000000, "general error"},
    Reason{0x08000020, "cannot be stored"},
    Reason{0x08000021, "refused: under local control"},
    Reason{0x08000022, "refused in the device's present state"},
    Reason{0x08000023, "no object dictionary"},
    Reason{0x08000024, "no value there"},
};

}  // namespace

std::string_view abort_name(std::uint32_t code) noexcept {
  const auto* found =
      std::find_if(kReasons.begin(), kReasons.end(), [code](const Reason& r) { return r.code == code; });
  return found == kReasons.end() ? "unknown reason" : found->name;
}

}  // namespace jaywalk::canopen
