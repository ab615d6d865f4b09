#include "apps/jaywalk/commands.h"

#include <cmath>

#include "hal/shown_text.h"
#include "hal/types/errors.h"

namespace jaywalk {
namespace {

std::uint16_t port_of(const std::string& word) {
  if (const auto port = number_in<std::uint16_t>(word)) return *port;
  throw StartupError("--view: " + shown(word) + " is no port",
                     "give a whole number from 0 to 65535 (0: any that is free)");
}

}  // namespace

void add_place(CLI::App& command, const std::string& name, int count,
               const std::function<void(const std::vector<double>&)>& take, const std::string& description) {
  const auto take_sound = [=](const std::vector<double>& values) {
    for (const double value : values)
      if (!(std::fabs(value) <= 1e6))
        throw StartupError(name + formatted(": %g is no place", value), "give metres and radians");
    take(values);
  };
  command.add_option_function<std::vector<double>>(name, take_sound, description)->delimiter(',')->expected(count);
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
