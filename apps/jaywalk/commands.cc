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

template <class Place>
void add_place(CLI::App& command, const std::string& name, std::optional<Place>& chosen,
               const std::string& description) {
  constexpr bool kIsPose = std::is_same_v<Place, Pose2>;
  const auto take = [&chosen, name](const std::vector<double>& v) {
    for (const double value : v)
      if (!(std::fabs(value) <= 1e6))
        throw StartupError(name + formatted(": %g is no place", value), "give metres and radians");
    chosen = {v[0], v[1]};
    if constexpr (kIsPose) chosen->heading = wrap_angle(v[2]);
  };
  command.add_option_function<std::vector<double>>(name, take, description)->delimiter(',')->expected(kIsPose ? 3 : 2);
}
template void add_place(CLI::App&, const std::string&, std::optional<Vec2>&, const std::string&);
template void add_place(CLI::App&, const std::string&, std::optional<Pose2>&, const std::string&);

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

}  // namespace jaywalk
