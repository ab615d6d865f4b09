#include <asm/termbits.h>
#include <sys/ioctl.h>

#include <string>

#include "drivers/laser/scanner_connection.h"
#include "drivers/wire/byte_link.h"
#include "hal/types/errors.h"
#include "hil/emulators/scanners.h"
#include "tests/drivers/hand_clock.h"
#include "tests/drivers/serial_line.h"
#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

std::string refusal(const ScannerSetup& setup) {
  tests::HandClock clock;
  try {
    return make_scanner(setup, clock)->name();
  } catch (const StartupError& error) {
    return error.what();
  }
}

}  // namespace

TEST_CASE("a scanner is made where its maker's port or rate puts it") {
  CHECK(refusal({.kind = ScannerKind::kSickColaA, .host = "127.0.0.1"}) == "127.0.0.1:2112");
  CHECK(refusal({.kind = ScannerKind::kSickColaB, .host = "127.0.0.1", .port = 2111}) == "127.0.0.1:2111");
  CHECK(refusal({.kind = ScannerKind::kHokuyo, .host = "127.0.0.1"}) == "127.0.0.1:10940");
  CHECK(refusal({.kind = ScannerKind::kHokuyo, .device = "/dev/ttyACM7"}) == "/dev/ttyACM7");
  CHECK(refusal({.kind = ScannerKind::kLdrobot, .device = "/dev/ttyUSB7"}) == "/dev/ttyUSB7");
  CHECK(refusal({.kind = ScannerKind::kLms200, .device = "/dev/ttyS7", .baud = 500000}) == "/dev/ttyS7");
  CHECK(refusal({.kind = ScannerKind::kRplidar, .device = "/dev/ttyUSB8"}) == "/dev/ttyUSB8");
}

TEST_CASE("a scanner on a wire that it does not have is refused with what to do") {
  CHECK(refusal({.kind = ScannerKind::kLdrobot, .host = "127.0.0.1"}) ==
        "127.0.0.1: ld19 is not on a network; give its serial device");
  CHECK(refusal({.kind = ScannerKind::kSickColaB, .device = "/dev/ttyUSB0"}) ==
        "/dev/ttyUSB0: sick-cola-b is not on a serial line; give its host");
  CHECK(refusal({.kind = ScannerKind::kHokuyo}).starts_with("scanner: neither host nor device; "));
  CHECK(refusal({.kind = ScannerKind::kHokuyo, .host = "127.0.0.1", .device = "/dev/ttyACM0"})
            .starts_with("scanner: both host and device; "));
}

TEST_CASE("scanners are known by their names") {
  CHECK(scanner_kind("sick-cola-a") == ScannerKind::kSickColaA);
  CHECK(scanner_kind("rplidar") == ScannerKind::kRplidar);
  CHECK_FALSE(scanner_kind("sick"));
  CHECK_FALSE(scanner_kind(""));
}

TEST_CASE("a serial line is opened at any rate, 256000 baud of an RPLIDAR A3 among them") {
  const auto line = tests::serial_line();
  if (!line) return;
  for (const std::uint32_t baud : {9600U, 115200U, 230400U, 256000U, 460800U, 1'000'000U, 74'880U}) {
    const wire::FileDescriptor opened = wire::serial_endpoint(line->path(), baud).open();
    REQUIRE(opened.get() >= 0);
    termios2 settings{};
    REQUIRE(::ioctl(opened.get(), TCGETS2, &settings) == 0);
    CHECK(settings.c_ispeed == baud);
    CHECK(settings.c_ospeed == baud);
    CHECK((settings.c_lflag & (ICANON | ECHO)) == 0);
    CHECK((settings.c_iflag & (ICRNL | IXON)) == 0);
    CHECK((settings.c_cflag & CSIZE) == CS8);
  }
}

TEST_CASE("what is no rate is refused with what to give") {
  CHECK_THROWS_WITH(wire::serial_endpoint("/dev/ttyUSB0", 0), Catch::Contains("no serial line runs at 0 baud; give"));
  CHECK_THROWS_AS(wire::serial_endpoint("/dev/ttyUSB0", 5'000'000), StartupError);
}
