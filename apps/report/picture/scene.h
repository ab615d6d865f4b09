#pragma once
// What a picture of a run shows. Everything is in the map's frame, metres and radians.
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "apps/report/trails.h"
#include "hal/types/geometry.h"
#include "hal/types/map_zones.h"
#include "hal/types/robot_model.h"
#include "planner/cost_to_go/planner.h"
#include "planner/mapping/evidence_map.h"
#include "planner/tracking/track.h"

namespace jaywalk {

struct Extent {
  Vec2 low, high;
};

struct WallLine {
  Vec2 from, to;
};

/// A plan's field with its numbers: rows from the lowest y, NaN where not free, inf where unreachable.
struct FieldRaster {
  Vec2 low;  ///< lower left corner of the first cell
  std::int32_t width = 0, height = 0;
  double cell_m = 0.0;
  std::vector<float> psi;
  FieldView::Of of = FieldView::Of::kPotential;
};

/// One moment's plan: what the controller believed, expected and meant to do then.
struct PlanMoment {
  Time t = kNever;
  Pose2 map_from_robot;
  std::vector<Track> tracks;
  std::vector<Prediction> predictions;
  std::vector<Vec2> band;
  FieldRaster field;
};

/// A way that was weighed.
struct WeighedWay {
  std::string name;  ///< "wait then go"
  std::vector<Vec2> places;
  float dearer_s = 0.0F;  ///< than the one chosen
};

/// Where a mover is in one of the futures that were drawn, and when: 0 now, 1 at the horizon.
struct FuturePlace {
  Vec2 at;
  double horizon_share = 0.0;
};

/// What one decision on motion rests on.
struct DecisionScene {
  std::vector<WeighedWay> ways;  ///< the best of each kind, cheapest first
  std::vector<Vec2> chosen;
  std::vector<FuturePlace> futures;
};

/// Parts that are empty are left out of the picture and of its legend. A field a part: more than a struct has
/// elsewhere.
struct PictureScene {
  std::string title;
  std::vector<std::pair<std::string, std::string>> facts;  ///< shown beside the map: "path", "46.2 m"
  Extent extent;                                           ///< what is shown; see extent_of
  std::vector<WallLine> walls;                             ///< as they really are
  std::vector<Vec2> occupied;                              ///< centres of cells that the robot saw occupied
  double cell_m = 0.1;
  std::vector<MapZone> zones;  ///< that a person drew
  std::vector<DrivenPose> driven;
  std::vector<Trail> movers;  ///< as they really went
  std::vector<Trail> tracks;  ///< as the controller followed them; drawn where there are no movers
  std::optional<PlanMoment> moment;
  std::optional<DecisionScene> decision;
  std::optional<Pose2> start;
  std::optional<Vec2> goal;
  double goal_tolerance_m = 0.3;
  std::optional<double> goal_heading_rad;  ///< where one was wanted there
  Footprint footprint;
};

/// Centres of the map's occupied cells within `reach_m` of the driven path's bounding box.
[[nodiscard]] std::vector<Vec2> occupied_cells(const EvidenceMap& map, const std::vector<DrivenPose>& driven,
                                               double reach_m);

/// What of the scene is worth showing: all walls; without them the robot's way and the cells seen
/// occupied but for the outermost half percent on each side; start and goal; a margin round it.
[[nodiscard]] Extent extent_of(const PictureScene& scene);

/// A copy of `view`.
[[nodiscard]] FieldRaster raster_of(const FieldView& view);

/// Keeps the plan at the run's busiest moment: the one with most expected near the robot; of equals the last whose path
/// is still half as long as the longest. Works outside the tick: it allocates.
class BusiestMoment {
 public:
  /// Offers a new plan; `planner` is asked for its field only when the moment is the busiest so far.
  /// Plans without a path are passed over.
  void consider(const Plan& plan, const Planner& planner, std::span<const Track> tracks, const Pose2& map_from_robot);
  [[nodiscard]] const std::optional<PlanMoment>& moment() const { return moment_; }

 private:
  double busiest_ = -1.0;
  std::size_t longest_path_ = 0;  ///< points
  std::optional<PlanMoment> moment_;
};

}  // namespace jaywalk
