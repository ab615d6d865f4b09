#pragma once
#include <cstdint>
#include <string>
#include <string_view>

#include "hil/emulators/scanner_server.h"

namespace jaywalk::emulators {

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
  std::vector<std::uint8_t> message_of(std::size_t first_beam, std::span<const float> range_m, Time began,
                                       Time now) override;

  [[nodiscard]] bool take_command(std::string& command);
  void obey(std::string_view command);
  void say(std::string_view body);
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

}  // namespace jaywalk::emulators
