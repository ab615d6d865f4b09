#include "tests/drivers/eds_file.h"

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

#include "drivers/canopen/cia402.h"
#include "hal/types/errors.h"
#include "tests/drivers/data_files.h"
#include "tests/drivers/random_bytes.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::canopen;

namespace {

/// A file that lives as long as the test.
class WrittenFile {
 public:
  explicit WrittenFile(const std::string& text)
      : path_(std::filesystem::temp_directory_path() / ("jaywalk_eds_" + std::to_string(::getpid()) + ".eds")) {
    std::ofstream(path_, std::ios::binary) << text;
  }
  ~WrittenFile() { std::filesystem::remove(path_); }
  WrittenFile(const WrittenFile&) = delete;
  WrittenFile& operator=(const WrittenFile&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

std::string refusal_of(const std::filesystem::path& path) {
  try {
    const EdsFile eds(path);
  } catch (const StartupError& error) {
    return error.what();
  }
  return "read";
}

std::optional<EdsFile> makers(const char* name) {
  const auto path = tests::data_file(std::filesystem::path("canopen") / name);
  if (path.empty()) return std::nullopt;
  return EdsFile(path);
}

std::string indices(const std::vector<NeededObject>& objects) {
  std::string text;
  for (const NeededObject& object : objects) {
    constexpr const char* kDigits = "0123456789ABCDEF";
    if (!text.empty()) text += ' ';
    for (int shift = 12; shift >= 0; shift -= 4) text += kDigits[(object.address.index >> shift) & 0xF];
  }
  return text;
}

}  // namespace

TEST_CASE("objects and their access are read from a data sheet") {
  const WrittenFile file(
      "; a remark\r\n[DeviceInfo]\r\nVendorName=nobody\r\n[1016]\r\nParameterName=Watch\r\nSubNumber=2\r\n"
      "[1016sub0]\r\nParameterName=Count\r\nAccessType=ro\r\n[1016SUB1]\r\nAccessType = RW\r\n"
      "[60ff]\r\nParameterName=Target velocity\r\nAccessType=rww\r\n");
  const EdsFile eds(file.path());
  CHECK(eds.size() == 3);
  REQUIRE(eds.find({0x1016, 1}) != nullptr);
  CHECK(eds.find({0x1016, 1})->is_writable());
  CHECK_FALSE(eds.find({0x1016, 0})->is_writable());
  REQUIRE(eds.find({0x60FF, 0}) != nullptr);
  CHECK(eds.find({0x60FF, 0})->name == "Target velocity");
  CHECK(eds.find({0x60FF, 0})->line == 12);
  CHECK(eds.find({0x6040, 0}) == nullptr);
}

TEST_CASE("an object that can only be read does not count as writable") {
  const WrittenFile file("[6040]\nAccessType=ro\n[6041]\nAccessType=ro\n");
  const auto lacks = shortcomings(EdsFile(file.path()));
  CHECK(indices(lacks.for_driving) == "6040 6060 6061 60FF 606C 6064");
}

TEST_CASE("a missing, an empty and a broken data sheet are refused with their place") {
  CHECK(refusal_of("nowhere.eds") == "nowhere.eds: cannot be read; name the EDS file that the drive's maker gives out");
  const WrittenFile broken("[DeviceInfo]\n[6040\n");
  CHECK(refusal_of(broken.path()) ==
        broken.path().string() + ":2: a section without ]; use the maker's file unchanged");
  const WrittenFile empty("[DeviceInfo]\n");
  CHECK(refusal_of(empty.path()) == empty.path().string() + ": no object in it; name an EDS file (CiA 306)");
  const WrittenFile twice("[6040]\nAccessType=rw\n[6040]\nAccessType=rw\n");
  CHECK(refusal_of(twice.path()) == twice.path().string() + ":3: object stands twice; use the maker's file unchanged");
}

TEST_CASE("the ros2_canopen drive can be driven, lacks the abort connection option alone, and has three fixed ones") {
  const auto eds = makers("cia402_slave_ros2canopen.eds");
  if (!eds) return;
  const auto lacks = shortcomings(*eds);
  CHECK(indices(lacks.for_driving).empty());
  CHECK(indices(lacks.for_proof) == "6007");
  CHECK(indices(lacks.fixed_for_proof) == "605B 605C 605E");
}

TEST_CASE("the RoboteQ controllers offer the heartbeats and no CiA 402 drive at all") {
  const auto eds = makers("roboteq_motor_controllers_v60.eds");
  if (!eds) return;
  const auto lacks = shortcomings(*eds);
  CHECK(indices(lacks.for_driving) == "6040 6041 6060 6061 60FF 606C 6064");
  CHECK(indices(lacks.for_proof) == "6007 605A 605B 605C 605D 605E 6084 6085");
  CHECK(indices(lacks.fixed_for_proof).empty());
}

TEST_CASE("any text is a data sheet or refused") {
  const std::string good = "[1016]\nParameterName=W\n[1016sub1]\nAccessType=rw\n[6040]\nAccessType=rw\n";
  tests::RandomBytes random(21);
  int refused = 0;
  for (int k = 0; k < 1000; ++k) {
    const auto bytes = random.damaged({reinterpret_cast<const std::uint8_t*>(good.data()), good.size()});
    const WrittenFile file(std::string(bytes.begin(), bytes.end()));
    if (refusal_of(file.path()) != "read") ++refused;
  }
  CHECK(refused > 0);
  CHECK(refused < 1000);
}
