#include "apps/jaywalk/commands.h"

#include <charconv>
#include <cstdio>

#include "hal/shown_text.h"
#include "hal/types/errors.h"

namespace jaywalk {
namespace {

std::uint16_t port_of(const std::string& word) {
  std::uint16_t port = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), port);
  if (error == std::errc() && end == word.data() + word.size()) return port;
  throw StartupError("--view: " + shown(word) + " is no port",
                     "give a whole number from 0 to 65535 (0: any that is free)");
}

}  // namespace

double sound(const char* option, double value) {
  constexpr double kFarthest = 1e6;
  if (value >= -kFarthest && value <= kFarthest) return value;
  const std::string text = formatted("%g", value);
  throw StartupError(std::string(option) + ": " + text + " is no place", "give metres and radians");
}

void add_view(CLI::App& command, std::optional<view::ViewAddress>& chosen) {
  const auto here = [&chosen]() -> view::ViewAddress& { return chosen ? *chosen : chosen.emplace(); };
  command
      .add_option_function<std::string>(
          "--view", [here](const std::string& word) { here().port = word.empty() ? std::uint16_t{0} : port_of(word); },
          "Serve the live page; its address is printed (default port: any that is free)")
      ->expected(0, 1)
      ->type_name("PORT");
  command
      .add_option_function<std::string>(
          "--view-address", [here](const std::string& word) { here().address = word; },
          "Serve it on this IPv4 address, by TLS and with a token (default: 127.0.0.1, this machine alone)")
      ->type_name("ADDRESS");
  command
      .add_option_function<std::string>(
          "--view-certificate", [here](const std::string& word) { here().certificate = word; },
          "Certificate and key for TLS, in PEM (default: self-signed)")
      ->type_name("FILE");
  command
      .add_option_function<std::string>(
          "--view-origin", [here](const std::string& word) { here().origin = word; },
          "Pages of this site may look and steer too, such as a Foxglove that is served from there")
      ->type_name("https://SITE");
}

}  // namespace jaywalk
