#include "apps/jaywalk/commands.h"

#include "firmware/recording/map_files.h"
#include "hal/types/errors.h"

namespace jaywalk {
namespace {

std::uint16_t port_of(const std::string& word) {
  if (const auto port = number_in<std::uint16_t>(word)) return *port;
  throw StartupError("--view: " + shown(word) + " is no port",
                     "give a whole number from 0 to 65535 (0: any that is free)");
}

}  // namespace

void add_view(CLI::App& command, std::optional<view::ViewAddress>& chosen) {
  const auto add = [&](const char* name, const char* type, const auto& take, const char* about) {
    const auto choose = [&chosen, take](const std::string& word) { take(chosen ? *chosen : chosen.emplace(), word); };
    return command.add_option_function<std::string>(name, choose, about)->type_name(type);
  };
  const auto into = [](auto member) {
    return [member](view::ViewAddress& address, const std::string& word) { address.*member = word; };
  };
  const auto port = [](view::ViewAddress& address, const std::string& word) {
    address.port = word.empty() ? std::uint16_t{0} : port_of(word);
  };
  add("--view", "PORT", port, "Serve the live page; its address is printed (default port: any that is free)")
      ->expected(0, 1);
  add("--view-address", "ADDRESS", into(&view::ViewAddress::address),
      "Serve it on this IPv4 address, by TLS and with a token (default: 127.0.0.1, this machine alone)");
  add("--view-certificate", "FILE", into(&view::ViewAddress::certificate),
      "Certificate and key for TLS, in PEM (default: self-signed)");
  add("--view-origin", "https://SITE", into(&view::ViewAddress::origin),
      "Pages of this site may look and steer too, such as a Foxglove that is served from there");
}

void add_loop_options(CLI::App& command, LoopOptions& options) {
  command.add_option("--out", options.out, "Folder for what the run leaves")->capture_default_str();
  command.add_flag("--save-map", options.save_map, "Save what the robot saw: map.yaml and map.pgm (map_server)");
  command.add_flag("--mcap", options.mcap, "Leave run.mcap as well, as export would");
  command.add_flag("--json", options.json, "Print the summary, in place of a line");
  add_view(command, options.view);
}

void conclude(const LoopOptions& options, LoopRunner& runner, RunEnd end, const std::string& told) {
  const std::filesystem::path drawn = runner.finish(std::move(end));
  if (options.save_map) save_map(runner.loop().tracker().still(), options.out);
  runner.require_recorded();
  if (options.json)
    print_summary(options.out);
  else
    std::printf("%s; see %s\n", told.c_str(), drawn.c_str());
  std::fflush(stdout);
}

}  // namespace jaywalk
