#pragma once
// The planner's door: what it is asked, what it answers, and the two calls in between.
#include <cstdint>
#include <memory>
#include <span>

#include "hal/types/fixed_vector.h"
#include "hal/types/geometry.h"
#include "hal/types/robot_model.h"
#include "hal/types/time.h"
#include "planner/cost_to_go/guide.h"
#include "planner/cost_to_go/pose_guide.h"
#include "planner/mapping/evidence_map.h"
#include "planner/mapping/known_map.h"
#include "planner/tracking/occlusion.h"
#include "planner/tracking/track.h"

namespace jaywalk {

enum class PlanStatus : std::uint8_t {
  kNone,           ///< nothing was planned yet
  kOk,             ///< `path` leads to the goal
  kNoPath,         ///< no way through free cells, or no room for the body as it is to stand at the goal
  kRobotBlocked,   ///< the robot's own cell is not free and no free cell is near
  kBadRequest,     ///< a pose or goal that is not finite
  kBackendFailed,  ///< the executor could not run
};
[[nodiscard]] const char* name_of(PlanStatus status);

inline constexpr std::size_t kMaxPathPoints = 4096;

/// Points in the map, from the robot to the goal (or to where the goal projects onto the grid's
/// border), 0.05 to 0.2 m apart. Empty unless the status is kOk.
using Path = FixedVector<Vec2, kMaxPathPoints>;

/// A body that is no wall, though the map may hold one there: it stood, and was mapped.
struct MoverDisc {
  Vec2 centre_in_map;
  double radius_m = 0.0;
};
inline constexpr double kOwnBody_m = 0.2;  ///< beyond its radius what is mapped may be its own: noise, legs, its way

/// The time to go from poses; asked for where the body is not round, or the goal has a heading.
struct PoseRequest {
  bool is_asked = false;
  PoseSpeeds speeds;
  float arrives_m = 0.15F;  ///< of the goal: there
  bool wants_heading = false;
  float heading = 0.0F;
  /// In the map: what is a wall most likely, where the laser does not look now. Read during submit only.
  std::span<const Vec2> unseen_walls{};
};
inline constexpr std::size_t kMaxUnseenWalls = 1024;

struct PlanRequest {
  Time stamp = kNever;  ///< of the scan that the request rests on
  Pose2 map_from_robot;
  Vec2 goal_in_map;
  double speed_mps = 0.0;              ///< the robot's cruising speed: warp numbers count its travel
  const EvidenceMap* still = nullptr;  ///< walls; read during submit only
  std::span<const Track> moving = {};  ///< for marks (planner/paper); copied during submit
  /// Standing pedestrians, with body radius: time to go is dear beside them, potential closed. Read during submit only.
  std::span<const StandingPedestrian> standing = {};
  std::span<const MoverDisc> masked = {};  ///< for the time to go; read during submit only
  PoseRequest poses{};
};

/// Where a mover is expected, and how it was marked.
struct Prediction {
  std::uint32_t track_id = 0;
  Vec2 position_in_map;
  double mark_radius_m = 0.0;
};

/// What a plan took; for reports only, no decision rests on it.
struct PlanTook {
  double ms = 0.0;            ///< from submission until it was finished
  double processor_ms = 0.0;  ///< of that, the submitting thread's own work
  double device_ms = 0.0;     ///< of that, a device's by its own clock; 0 on the CPU
};

struct Plan {
  Time stamp = kNever;         ///< the request's
  std::uint32_t sequence = 0;  ///< of the request that it answers, from 1
  PlanStatus status = PlanStatus::kNone;
  bool certified = false;   ///< every goal-connected free cell has a lower neighbour; of the time to go: kNoPath holds
  float reach = 0.0F;       ///< share of goal-connected free cells from which descent arrives
  std::int32_t cycles = 0;  ///< of the potential's solver; 0 where none is solved
  PlanTook took;
  Path path;
  Guide guide;                                      ///< to motion; whatever the status
  PoseGuide poses;                                  ///< the same, where it was asked for
  FixedVector<Prediction, kMaxTracks> predictions;  ///< where movers are marked
};

/// A plan's field for pictures; see Planner::view_field.
struct FieldView {
  enum class Of : std::uint8_t { kPotential, kTimeToGo };
  Of of = Of::kPotential;
  CellIndex low;  ///< world index of the window's lowest cell
  std::int32_t width = 0, height = 0;
  double cell_m = 0.0;
  /// -ln(1 - phi), or seconds to the goal, row by row from the lowest y; NaN where not free, inf where unreachable.
  std::span<const float> psi;
};

struct PlannerConfig {
  double cell_m = 0.1;
  std::int32_t side_cells = 256;                   ///< side of the grid at start: 256, 512 or 1024
  std::int32_t max_side_cells = 1024;              ///< memory is taken for this; the grid doubles up to it when the
                                                   ///< goal cannot be reached inside it
  Footprint body{0.2236, 0.2236, 0.2};             ///< for the time to go
  std::shared_ptr<const KeepOutField> keep_out{};  ///< where the robot must not be; null: nowhere
  std::shared_ptr<const KnownMap> known_map{};     ///< for ways beyond the window; null: what is seen on the way
};

/// Side (cells) of a grid of `cell_m` cells that holds start and goal with room around them: 256, 512 or 1024; 512
/// where none holds both, and a FarGuide leads on.
[[nodiscard]] std::int32_t grid_side_for(Vec2 start_in_map, Vec2 goal_in_map, double cell_m);

/// Plans on a window of the world. submit() hands over a request, collect() the newest finished
/// plan: a tick later at the earliest, so that every backend has the same latency.
///
/// Constructor allocates everything; submit, collect and path never do, nor do they throw.
/// Thread: the loop's.
class Planner {
 public:
  virtual ~Planner() = default;
  virtual void submit(const PlanRequest& request) noexcept = 0;
  /// True while an earlier request is being answered and no other is taken.
  [[nodiscard]] virtual bool is_busy() const noexcept { return false; }
  [[nodiscard]] virtual const Plan& collect() noexcept = 0;
  /// The field behind the plan that collect() last returned. For pictures: never in the loop.
  [[nodiscard]] virtual FieldView view_field() const = 0;
  [[nodiscard]] virtual const char* backend() const noexcept = 0;
  /// Why the last submission came to kBackendFailed, in a few words.
  [[nodiscard]] virtual const char* failure() const noexcept { return ""; }
};

/// Plans by the time to go, on the CPU. Throws StartupError for a configuration that makes no sense.
[[nodiscard]] std::unique_ptr<Planner> make_cpu_planner(const PlannerConfig& config);

// Rules of thumb that planners share, and what they refuse.
namespace field {

/// A robot that stands in an obstacle or its inflation starts from the nearest free cell this near.
inline constexpr double kStartRadius_m = 1.0;
/// A goal that is not free is replaced by the nearest cell this near that the robot can reach.
inline constexpr double kGoalRadius_m = 0.5;

/// Throws StartupError for a configuration that makes no sense.
void check(const PlannerConfig& config);
/// Throws StartupError for one value that makes none.
void refuse_unless(bool makes_sense, const char* name, double value, const char* remedy);

/// True where pose, goal and speed are numbers.
[[nodiscard]] bool is_finite(const PlanRequest& request) noexcept;

}  // namespace field
}  // namespace jaywalk
