#pragma once
// Emulated scanners: Hokuyo and SICK on a network; LD19, RPLIDAR and LMS200 on a serial line.
#include "hil/emulators/scanner_server.h"

namespace jaywalk::emulators {

struct ScipModel {
  std::uint32_t steps_per_turn = 1440;
  std::uint32_t first_step = 0;
  std::uint32_t last_step = 1080;
  std::uint32_t front_step = 540;
  std::uint32_t turns_per_minute = 2400;
  std::uint32_t range_min_mm = 23;
  std::uint32_t range_max_mm = 60000;
};

/// A Hokuyo that speaks SCIP 2: QT, PP, BM, and MD over any of its steps; what it does not know is refused with 0E. Its
/// clock of 24 bits wraps two seconds after ours began. A new peer finds it as the last one left it, as on a serial
/// line.
class ScipServer final : public ScannerServer {
 public:
  ScipServer(std::unique_ptr<ByteServer> wire, const ScipModel& model, World world);

  /// It speaks SCIP 1.1 until it hears SCIP2.0, as a URG-04LX.
  void begin_with_scip_1() noexcept { speaks_scip_2_ = false; }
  void break_laser() noexcept { broken_ = true; }
  /// The status that comes in place of each scan, as "0L" for a broken laser; empty: it is well.
  void set_status(std::string status) { status_ = std::move(status); }

 private:
  void on_bytes(wire::Bytes bytes) override;
  Message message_of(std::size_t first_beam, Ranges range_m, Time began, Time now) override;

  void obey(const std::string& command);
  void begin_scans(const std::string& command);
  void say(const std::string& command, const std::string& status, const std::string& lines = "");
  [[nodiscard]] std::string parameters() const;
  [[nodiscard]] std::uint32_t joined_mm(std::span<const float> range_m) const;

  ScipModel model_;
  std::string came_in_;
  std::string asked_;  ///< the MD that is being answered
  std::uint32_t first_ = 0, last_ = 0, joined_ = 1;
  bool laser_on_ = false;
  bool broken_ = false;
  bool speaks_scip_2_ = true;
  std::string status_;
};

enum class ColaDialect : std::uint8_t { kText, kBinary };

/// What kind of SICK scanner it is; a TiM561 as it comes from the factory.
struct SickModel {
  ColaDialect dialect = ColaDialect::kBinary;
  std::uint32_t beams = 811;
  std::int32_t first_angle_tdeg = -450000;  ///< ten-thousandths of a degree; 900000 is straight ahead
  std::uint16_t step_tdeg = 3333;
  double rate_hz = 15.0;
  double range_max_m = 10.0;
};

/// A SICK scanner that speaks CoLa A or B: takes its login, settings and "scans on", refuses what it does not know.
/// Its clock wraps ten seconds after ours began.
class SickServer final : public ScannerServer {
 public:
  SickServer(std::unique_ptr<ByteServer> wire, const SickModel& model, World world);

  /// From now on the command with this word is refused, as by a scanner that does not have it.
  void refuse(std::string word) { refused_word_ = std::move(word); }
  /// From now on the command with this word is not answered, and not obeyed.
  void ignore(std::string word) { ignored_word_ = std::move(word); }
  /// The status bit that says "error" in every telegram.
  void set_unwell(bool unwell) noexcept { unwell_ = unwell; }
  /// The status bits that speak of contamination.
  [[nodiscard]] bool set_window(Window window) override {
    window_ = window;
    return true;
  }

 private:
  void on_new_peer() override;
  void on_bytes(wire::Bytes bytes) override;
  Message message_of(std::size_t first_beam, Ranges range_m, Time began, Time now) override;

  [[nodiscard]] bool take_command(std::string& command);
  void obey(std::string_view command);
  void say(std::string_view body) { answer(framed(body)); }
  [[nodiscard]] std::string framed(std::string_view body) const;

  SickModel model_;
  std::string came_in_;
  std::string refused_word_, ignored_word_;
  bool logged_in_ = false;
  bool unwell_ = false;
  Window window_ = Window::kClean;
  std::uint16_t telegrams_ = 0;
  std::uint16_t sweeps_ = 0;
};

/// An LD19: ten turns a second, clockwise, 38 packets of 12 points a turn, to every listener. It obeys nothing.
class LdServer final : public ScannerServer {
 public:
  LdServer(std::unique_ptr<ByteServer> wire, World world);

 private:
  void on_new_peer() override { set_streaming(true); }
  Message message_of(std::size_t first_beam, Ranges range_m, Time began, Time now) override;
};

/// An RPLIDAR A2: ten turns a second of 360 points, clockwise. It hears stop, scan, health and the motor's speed, and
/// measures while its motor runs. A new peer finds it as the last one left it.
class RplidarServer final : public ScannerServer {
 public:
  RplidarServer(std::unique_ptr<ByteServer> wire, World world);

  void break_down() noexcept { status_ = 2; }
  /// Its turns begin at this angle, degrees, and end beyond 360.
  void begin_turns_at(double angle_deg) noexcept { first_q6_ = static_cast<unsigned>(64.0 * angle_deg); }

 private:
  void on_bytes(wire::Bytes bytes) override;
  Message message_of(std::size_t first_beam, Ranges range_m, Time began, Time now) override;
  void obey(std::uint8_t command);

  std::vector<std::uint8_t> came_in_;
  bool motor_runs_ = false;
  std::uint8_t status_ = 0;
  unsigned first_q6_ = 0;
};

/// An LMS200 with 181 beams in centimetres: sends all its values or none, as it is told. What its line takes for a
/// telegram it takes here too.
class Lms200Server final : public ScannerServer {
 public:
  Lms200Server(std::unique_ptr<ByteServer> wire, std::uint32_t baud, World world);

  /// The status in its telegrams: 0 well, 2 warning, 3 error, 4 fatal; 40h more: implausible values, 80h more: dirt.
  void set_status(std::uint8_t status) noexcept { status_ = status; }
  [[nodiscard]] bool set_window(Window window) override;

 private:
  void on_bytes(wire::Bytes bytes) override;
  Message message_of(std::size_t first_beam, Ranges range_m, Time began, Time now) override;
  [[nodiscard]] std::vector<std::uint8_t> framed(std::span<const std::uint8_t> body) const;

  std::vector<std::uint8_t> came_in_;
  std::uint8_t status_ = 0;
};

}  // namespace jaywalk::emulators
