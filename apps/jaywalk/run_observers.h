#pragma once
#include <CLI/CLI.hpp>
#include <charconv>
#include <optional>
#include <string>

#include "apps/view/view_server.h"
#include "firmware/program/run_command.h"
#include "hal/shown_text.h"
#include "hal/types/errors.h"

namespace jaywalk {

/// Adds the live page's options to `jaywalk run`, which add_robot_commands() has added.
void add_run_view(CLI::App& app);

/// A MakeObserver: tables and pictures, and the live page where it was asked for.
[[nodiscard]] std::unique_ptr<TickObserver> observe_run(const RunOptions& options, const RobotFile& file,
                                                        const std::filesystem::path& control_socket);

inline std::uint16_t port_of(const std::string& word) {
  std::uint16_t port = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), port);
  if (error == std::errc() && end == word.data() + word.size()) return port;
  throw StartupError("--view: " + shown(word) + " is no port",
                     "give a whole number from 0 to 65535 (0: any that is free)");
}

/// --view [PORT], --view-address, --view-certificate and --view-origin. Parsing throws StartupError for what is no
/// port.
inline void add_view(CLI::App& command, std::optional<view::ViewAddress>& chosen) {
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
