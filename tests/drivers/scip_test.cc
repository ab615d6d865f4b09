#include "drivers/laser/scip.h"

#include <memory>
#include <string>

#include "tests/support/allocation_guard.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::scip;
using namespace std::chrono_literals;

namespace {

std::string checked_line(const std::string& line) { return line + checksum(line) + "\n"; }

wire::Bytes bytes_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

/// Three beams, steps 0539 to 0541: 5432, 1 (an error code) and 4095 mm, in 3 characters each. An answer's last line
/// end belongs to the empty line that ends it.
std::string three_beams() {
  std::string answer = "MD0539054101001\n" + checked_line("99") + checked_line("0001") + checked_line("1Dh0010oo");
  answer.pop_back();
  return answer;
}

/// A scan and the scanner's own time of it.
std::pair<LaserScan, std::uint32_t> decoded(const std::string& answer, const ScannerModel& model = {}) {
  std::pair<LaserScan, std::uint32_t> made;
  REQUIRE(decode_scan(answer, model, Time{1s}, made.first, made.second) == Heard::kScan);
  return made;
}

}  // namespace

TEST_CASE("numbers and checksums are those of Hokuyo's specification") {
  CHECK(checksum("Hokuyo") == 'o');
  CHECK(checksum("00") == 'P');
  CHECK(checksum("99") == 'b');
  CHECK(decode_number("CB") == 1234U);
  CHECK(decode_number("1Dh") == 5432U);
  CHECK(decode_number("m2@0") == 16000000U);
  CHECK_FALSE(decode_number("1/h"));  // 2Fh is one below the first
  CHECK_FALSE(decode_number("1ph"));  // 70h is one above the last
  CHECK_FALSE(decode_number(""));
}

TEST_CASE("three distances of three characters decode") {
  const auto [scan, device_time_ms] = decoded(three_beams());
  CHECK(device_time_ms == 1);
  REQUIRE(scan.beam_count == 3);
  CHECK(scan.range_m[0] == Approx(5.432F));
  CHECK_FALSE(scan.is_hit(1));
  CHECK(scan.range_m[2] == Approx(4.095F));            // "0oo": 0, 63 * 64 + 63
  CHECK(scan.first_angle_rad == Approx(-0.00436332));  // one step of 360/1440 degrees right of ahead
  CHECK(scan.angle_step_rad == Approx(0.00436332));    // 0.25 degrees
  CHECK(to_seconds(scan.sweep) == Approx(25e-3 * 2 / 1440));
  CHECK(to_seconds(scan.stamp) == Approx(1.0 - 25e-3 * 2 / 1440));
}

TEST_CASE("two-character distances and clusters decode") {
  // Steps 540 to 545 by 3: two beams.
  const std::string answer = "GS0540054503\n" + checked_line("00") + checked_line("m2@0") + checked_line("CBCB");
  const auto [scan, device_time_ms] = decoded(answer);
  CHECK(device_time_ms == 16000000);
  REQUIRE(scan.beam_count == 2);
  CHECK(scan.range_m[1] == Approx(1.234F));
  CHECK(scan.angle_step_rad == Approx(3 * 0.00436332));
}

TEST_CASE("a number may begin on one line and end on the next") {
  // 22 beams of three characters: 64 characters, and 2 more.
  std::string characters;
  for (int k = 0; k < 22; ++k) characters += "1Dh";
  const std::string answer = "MD0000002101000\n" + checked_line("99") + checked_line("0000") +
                             checked_line(characters.substr(0, 64)) + checked_line(characters.substr(64));
  const LaserScan scan = decoded(answer).first;
  REQUIRE(scan.beam_count == 22);
  CHECK(scan.range_m[21] == Approx(5.432F));
}

TEST_CASE("what is no scan is named") {
  auto scan = std::make_unique<LaserScan>();
  std::uint32_t t = 0;
  const auto of = [&](const std::string& answer) { return decode_scan(answer, {}, Time{1s}, *scan, t); };
  CHECK(of("BM\n" + checked_line("00")) == Heard::kAnswer);
  CHECK(of("MD0539054101001\n" + checked_line("00")) == Heard::kAnswer);       // scans will follow
  CHECK(of("MD0539054101001\n" + checked_line("0L")) == Heard::kDeviceError);  // laser failure
  CHECK(of("MD0541053901001\n" + checked_line("99")) == Heard::kMalformed);
  CHECK(of("MD0539054101001\n99c\n") == Heard::kMalformed);
  std::string flipped = three_beams();
  flipped[flipped.find("1Dh") + 1] = 'E';
  CHECK(of(flipped) == Heard::kMalformed);
  CHECK(of("MD0539054201001\n" + three_beams().substr(16)) == Heard::kMalformed);  // four beams were asked for
  CHECK(of("") == Heard::kAnswer);
}

TEST_CASE("only a UTM-30LX says by 1 that nothing is in its range, every other code proves nothing") {
  // 0 to 5: error codes; 50: 5 cm; 65533: "0" and 16 * 4096 - 3; 23000 mm; 100 * 1024 mm, farther than the 30 m.
  const std::string answer =
      "MD0000000901000\n" + checked_line("99") + checked_line("0000") + checked_line("00000100200300400500b?om5UHI00");
  for (const bool is_utm : {true, false}) {
    const LaserScan scan = decoded(answer, {.one_means_nothing = is_utm}).first;
    REQUIRE(scan.beam_count == 10);
    CHECK(scan.state(1) == (is_utm ? BeamState::kFree : BeamState::kUnknown));
    for (const std::size_t beam : {0U, 2U, 3U, 4U, 5U, 6U, 7U}) CHECK(scan.state(beam) == BeamState::kUnknown);
    CHECK(scan.range_m[8] == Approx(22.872F));
    CHECK(scan.state(8) == BeamState::kHit);
    CHECK(scan.state(9) == BeamState::kFree);
  }
  // Of joined steps one may have been in error: 1 for all of them is not believed.
  const std::string joined = "MD0000000102000\n" + checked_line("99") + checked_line("0000") + checked_line("001");
  CHECK(decoded(joined, {.one_means_nothing = true}).first.state(0) == BeamState::kUnknown);
}

TEST_CASE("answers are cut out of a stream in pieces of any size without the heap") {
  const std::string stream = three_beams() + "\n\nBM\n" + checked_line("00") + "\n" + three_beams() + "\n\n";
  for (std::size_t piece = 1; piece <= stream.size(); ++piece) {
    AnswerStream answers;
    auto scan = std::make_unique<LaserScan>();
    int scans = 0;
    int others = 0;
    const AllocationGuard guard;
    for (std::size_t at = 0; at < stream.size(); at += piece) {
      answers.append(bytes_of(stream).subspan(at, std::min(piece, stream.size() - at)));
      std::uint32_t device_time_ms = 0;
      while (const auto answer = answers.next()) {
        const Heard decoding = decode_scan(*answer, {}, Time{1s}, *scan, device_time_ms);
        scans += decoding == Heard::kScan ? 1 : 0;
        others += decoding == Heard::kAnswer ? 1 : 0;
      }
    }
    const auto calls = guard.calls();
    REQUIRE(scans == 2);
    REQUIRE(others == 1);
    REQUIRE(calls == 0);
  }
}

TEST_CASE("what a URG-04LX says of itself is read") {
  // Checksums: D+M+I+N+:+2+0 = 452, 452 mod 64 = 4, '0' + 4 = '4'; A+M+I+N+:+4+4 = 455, 7, '7'.
  const std::string head = "PP\n00P\nMODL:URG-04LX(Hokuyo Automatic Co.,Ltd.);N\nDMIN:20;4\n";
  const std::string tail = "ARES:1024;\\\nAMIN:44;7\nAMAX:725;o\nAFRT:384;6\nSCAN:600;e";
  scip::ScannerModel model;
  REQUIRE(scip::decode_model(head + "DMAX:5600;_\n" + tail, model));
  CHECK(model.range_min_m == Approx(0.02));
  CHECK(model.range_max_m == Approx(5.6));
  CHECK(model.steps_per_turn == 1024);
  CHECK(model.first_step == 44);
  CHECK(model.last_step == 725);
  CHECK(model.front_step == 384);
  CHECK(model.period == std::chrono::milliseconds(100));
  CHECK_FALSE(model.one_means_nothing);
  CHECK_FALSE(scip::decode_model(head + tail, model));  // no DMAX
  CHECK_FALSE(scip::decode_model(head + "DMAX:5601;_\n" + tail, model));
  CHECK_FALSE(scip::decode_model(head + "DMAX:0;D\n" + tail, model));  // D+M+A+X+:+0 = 404, 20, 'D'
  CHECK_FALSE(scip::decode_model("PP\n0Ee\n", model));
  CHECK_FALSE(scip::decode_model("VV\n00P\n", model));
}

TEST_CASE("a UTM-30LX is known by its model's name, and one that is like it is not taken for it") {
  const auto is_utm = [](const std::string& name) {
    std::string answer = "PP\n" + checked_line("00");
    for (const std::string& line :
         {"MODL:" + name, std::string("DMIN:23"), std::string("DMAX:60000"), std::string("ARES:1440"),
          std::string("AMIN:0"), std::string("AMAX:1080"), std::string("AFRT:540"), std::string("SCAN:2400")}) {
      answer += line + ';' + checksum(line) + '\n';
    }
    scip::ScannerModel model;
    REQUIRE(scip::decode_model(answer, model));
    return model.one_means_nothing;
  };
  CHECK(is_utm("UTM-30LX(Hokuyo Automatic Co.,Ltd.)"));
  CHECK(is_utm("UTM-30LX"));
  CHECK_FALSE(is_utm("UTM-30LX-EW(Hokuyo Automatic Co.,Ltd.)"));
  CHECK_FALSE(is_utm("UST-10LX"));
  CHECK_FALSE(is_utm(""));
}
