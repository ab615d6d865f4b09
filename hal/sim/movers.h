#pragma once
// Simulated movers: those of the paper, which walk straight ahead and turn in place, and recorded ones.
#include <cstdint>
#include <span>
#include <vector>

#include "hal/sim/free_grid.h"
#include "hal/sim/random.h"
#include "hal/sim/simulation.h"
#include "hal/sim/walls.h"

namespace jaywalk::sim {

/// World in which movers are placed.
struct Ground {
  const Scenario& scenario;
  const Walls& walls;
  const FreeGrid& grid;
};

/// A random place in `within` with room to walls, start, goal and the movers `placed`. Throws StartupError without one.
[[nodiscard]] Vec2 free_place(const Ground& ground, const Box2& within, double radius_m,
                              std::span<const MoverTruth> placed, Random& random);

/// All wandering movers of a scenario. When anything lies in a mover's zone (kWanderZone), it stops, turns in place to
/// a random heading whose zone is free, and walks again. It is forced when the robot alone made it turn.
class Wanderers {
 public:
  /// Places them at random. Throws StartupError when there is no room. The ground's walls outlive this.
  Wanderers(const Ground& ground, std::uint64_t seed);

  /// Adds a mover of the scenario's first kind. False where there is no room.
  [[nodiscard]] bool add(const Ground& ground, std::uint64_t seed, std::uint32_t id,
                         std::span<const MoverTruth> placed);
  /// Removes the newest mover. False where there is none.
  [[nodiscard]] bool remove() noexcept {
    if (movers_.empty()) return false;
    movers_.pop_back();
    minds_.pop_back();
    return true;
  }

  /// Moves all on by `step_s`. `others` are movers that do not wander.
  void step(double step_s, const RobotBody& robot, std::span<const MoverTruth> others) noexcept;

  [[nodiscard]] std::span<const MoverTruth> movers() const noexcept { return movers_; }
  [[nodiscard]] std::uint32_t forced() const noexcept { return forced_; }
  /// True when in the last step a mover ran into the robot.
  [[nodiscard]] bool bumped_robot() const noexcept { return bumped_robot_; }

 private:
  enum class Activity : std::uint8_t { kWalking, kChoosing, kTurning };
  enum class Blocker : std::uint8_t { kNothing, kRobot, kOther };
  struct Mind {
    Activity activity = Activity::kWalking;
    double new_heading = 0.0;
    double speed_mps, turn_rate_radps, spontaneous_turns_hz;
    Random random;
  };
  struct Surroundings {
    const RobotBody& robot;
    std::span<const MoverTruth> others;
  };

  void place(const WanderSpec& spec, Vec2 position, std::uint64_t seed, std::uint32_t id, Random& random);
  [[nodiscard]] Blocker ahead(std::size_t self, double heading, const Surroundings& near) const noexcept;
  [[nodiscard]] Blocker touched(std::size_t self, Vec2 next, const Surroundings& near) const noexcept;
  void walk(std::size_t self, double step_s, const Surroundings& near) noexcept;
  void choose(std::size_t self, const Surroundings& near) noexcept;
  void turn(std::size_t self, double step_s) noexcept;
  void halt(std::size_t self, Blocker blocker) noexcept;

  const Walls& walls_;
  std::vector<MoverTruth> movers_;
  std::vector<Mind> minds_;
  std::uint32_t forced_ = 0;
  bool bumped_robot_ = false;
};

/// People who walk as recorded, straight from place to place, from their first row to their last, and heed nobody. One
/// counts as forced when the robot comes into its zone (kRecordedZone); standing ones look where they last walked.
class RecordedMovers {
 public:
  /// Reads t_s,id,x_m,y_m files; the simulation's movers get the ids after `last_id`. Throws StartupError.
  RecordedMovers(std::span<const RecordedSpec> specs, std::uint32_t last_id) : specs_(specs.begin(), specs.end()) {
    for (const RecordedSpec& spec : specs_) load(spec);
    for (Person& person : people_) person.truth.id = ++last_id;
    present_.reserve(people_.size());
  }

  void place(double now_s, const RobotBody& robot) noexcept;

  [[nodiscard]] std::span<const MoverTruth> movers() const noexcept { return present_; }  ///< there now
  /// Most that can be there at once.
  [[nodiscard]] std::size_t capacity() const noexcept { return people_.size(); }
  [[nodiscard]] std::uint32_t forced() const noexcept { return forced_; }

 private:
  struct Sample {
    double t_s;
    Vec2 position;
  };
  struct Person {
    std::vector<Sample> samples;  ///< in order of time
    std::size_t next = 1;         ///< sample that comes after the present time
    const RecordedSpec* spec;
    double begin_s, period_s;  ///< of the whole recording
    MoverTruth truth;
  };

  void load(const RecordedSpec& spec);
  [[nodiscard]] static bool move(Person& person, double now_s) noexcept;

  std::vector<RecordedSpec> specs_;
  std::vector<Person> people_;
  std::vector<MoverTruth> present_;
  std::uint32_t forced_ = 0;
};

}  // namespace jaywalk::sim
