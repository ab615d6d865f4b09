#include <asm/termbits.h>
#include <sys/ioctl.h>

#include "drivers/wire/byte_link.h"
#include "hal/types/errors.h"
#include "tests/drivers/serial_line.h"
#include "tests/support/catch.h"

using namespace jaywalk;

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
