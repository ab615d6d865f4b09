#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <span>

#include "drivers/can/socketcan.h"
#include "drivers/emulators/cia402_node.h"
#include "drivers/emulators/sick_server.h"
#include "hal/sim/world.h"

namespace jaywalk::rig {

/// How the simulated robot is wired; the controller's ROBOT.toml says the same from its side.
struct PlantWiring {
  std::string can = "vcan0";
  std::array<std::uint8_t, 2> nodes{2, 3};  ///< left, right
  double counts_per_wheel_turn = 76600.0;
  bool right_reversed = true;
  std::uint16_t scanner_port = 2112;
};

/// The simulated world as the far end of real wires: two CiA 402 drives turn its wheels, a SICK scanner looks round
/// in it. World time is the clock's time since construction.
class SimulatedRobot {
 public:
  /// `clock` outlives it. Throws StartupError.
  SimulatedRobot(const sim::Scenario& scenario, std::uint64_t seed, const PlantWiring& wiring, Clock& clock);

  /// Moves drives, world and scanner on to now.
  void step();

  [[nodiscard]] const sim::Truth& truth() const noexcept { return world_.truth(); }
  [[nodiscard]] emulators::Cia402Node& drive(std::size_t side) noexcept { return side == 0 ? left_ : right_; }
  [[nodiscard]] emulators::SickServer& scanner() noexcept { return scanner_; }
  /// rad/s, forward positive, as the drives would have the wheels turn.
  [[nodiscard]] double wheel_speed(std::size_t side) const noexcept;
  /// m/s at the rim of the faster wheel, as the drives would have it.
  [[nodiscard]] double rim_speed() const noexcept;
  /// The worse of the two drives' places on the bus.
  [[nodiscard]] CanHealth bus_health() const noexcept;

 private:
  void look(std::size_t first_beam, std::span<float> range_m);
  void turn_wheels();

  Clock& clock_;
  Time began_;
  sim::World world_;
  LaserModel laser_;
  double wheel_radius_m_;
  sim::Random noise_;
  std::array<double, 2> counts_per_rad_;
  SocketCan left_socket_, right_socket_;
  emulators::Cia402Node left_, right_;
  emulators::SickServer scanner_;
  Time encoders_read_ = kNever;
};

}  // namespace jaywalk::rig
