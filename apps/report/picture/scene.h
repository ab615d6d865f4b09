#pragma once
// Scene of a run's picture, in the map's frame, metres and radians, its trails, and its frame on the sheet.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "hal/maps/wall_map.h"
#include "hal/types/map_zones.h"
#include "hal/types/robot_model.h"
#include "hal/types/time.h"
#include "planner/cost_to_go/planner.h"
#include "planner/mapping/evidence_map.h"
#include "planner/tracking/track.h"

namespace jaywalk {

struct TrailPoint {
  Time t = kNever;
  Vec2 position;
};

/// The robot's pose at a time, and the laser's view from it.
struct DrivenPose {
  Time t = kNever;
  Pose2 pose;
  std::vector<Vec2> seen = {};  ///< ends of kShownBeams beams over the scan, in the laser's frame (m); of no scan none
};
inline constexpr std::size_t kShownBeams = 40;

/// The robot's own way: a pose every 0.2 s; where there would be more than kMostPoses (an hour), twice as long, and so
/// on.
class DrivenWay {
 public:
  static constexpr Duration kSpacing{200'000'000};
  static constexpr std::size_t kMostPoses = 18'000;

  void add(Time t, const Pose2& pose, const LaserScan& scan = {});
  [[nodiscard]] const std::vector<DrivenPose>& poses() const { return poses_; }

 private:
  Duration spacing_ = kSpacing;
  std::vector<DrivenPose> poses_;
};

/// One thing's way through the run.
struct Trail {
  std::uint32_t id = 0;
  double radius_m = 0.0;
  bool flagged = false;  ///< of a mover: was forced at some time; of a track: was moving at some time
  std::vector<TrailPoint> points;
};

/// Trails by id; a point is kept when its forerunner is 0.2 s old or older. Where there would be more than kMostPoints,
/// that time doubles, and so on; where there would be more than kMostTrails, the half that ended first is forgotten.
class TrailBook {
 public:
  static constexpr std::size_t kMostPoints = 200'000, kMostTrails = 4'000;

  void add(std::uint32_t id, Time t, Vec2 position, double radius_m, bool flag);
  /// In the order of their ids.
  [[nodiscard]] std::vector<Trail> trails() const {
    std::vector<Trail> all;
    for (const auto& [id, trail] : trails_) all.push_back(trail);
    return all;
  }

 private:
  void thin_out();
  void forget_oldest();

  Duration spacing_ = DrivenWay::kSpacing;
  std::size_t points_ = 0;
  std::map<std::uint32_t, Trail> trails_;
};

/// A box round points; empty without any.
struct Extent {
  Vec2 low{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  Vec2 high{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};

  void hold(Vec2 p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  [[nodiscard]] bool empty() const { return !(low.x <= high.x); }
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

/// Parts that are empty are left out of the picture and of its legend.
struct PictureScene {
  std::string title;
  std::vector<std::pair<std::string, std::string>> facts;  ///< shown beside the map: "path", "46.2 m"
  Extent extent;                                           ///< what is shown; see extent_of
  std::vector<sim::WallSegment> walls;                     ///< as they really are
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
  Pose2 robot_from_laser;
};

/// Centres of the map's occupied cells within `reach_m` of the driven path's bounding box.
[[nodiscard]] std::vector<Vec2> occupied_cells(const EvidenceMap& map, const std::vector<DrivenPose>& driven,
                                               double reach_m);

/// What of the scene is worth showing: all walls; without them the robot's way and the cells seen
/// occupied but for the outermost half percent on each side; start and goal; a margin round it.
[[nodiscard]] Extent extent_of(const PictureScene& scene);

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

/// From metres in the map to pixels on the sheet.
class MapFrame {
 public:
  /// The extent's upper left corner lies at `upper_left`; it is as large as `most` allows.
  MapFrame(const Extent& extent, Vec2 upper_left, Vec2 most)
      : extent_(extent), upper_left_(upper_left), pixels_per_m_(std::min(most.x / width_m(), most.y / height_m())) {}

  [[nodiscard]] double width_m() const { return extent_.high.x - extent_.low.x; }
  [[nodiscard]] double height_m() const { return extent_.high.y - extent_.low.y; }
  [[nodiscard]] double pixels(double metres) const { return metres * pixels_per_m_; }
  [[nodiscard]] Vec2 upper_left() const { return upper_left_; }
  [[nodiscard]] Vec2 size() const { return {pixels(width_m()), pixels(height_m())}; }
  [[nodiscard]] const Extent& extent() const { return extent_; }
  [[nodiscard]] Vec2 operator()(Vec2 p_in_map) const {
    return {upper_left_.x + pixels(p_in_map.x - extent_.low.x), upper_left_.y + pixels(extent_.high.y - p_in_map.y)};
  }

 private:
  Extent extent_;
  Vec2 upper_left_;
  double pixels_per_m_;
};

/// A run at equal steps of time, for the moving picture. Allocates; works outside the tick.
class Playback {
 public:
  /// Steps of 0.4 s, longer where there would be more than `most_steps` (2 or more). Keeps a reference to `driven`.
  Playback(const std::vector<DrivenPose>& driven, std::size_t most_steps);

  /// Seconds of the run that the playback covers, more than 0.
  [[nodiscard]] double lasts_s() const { return lasts_s_; }
  /// The robot at each step, headings continuous (rad, beyond pi where it turned round); empty without a driven pose.
  [[nodiscard]] std::vector<Pose2> robot() const;
  /// Scans at `count` equal steps (2 or more), where they were taken; none where there was none at all.
  [[nodiscard]] std::vector<DrivenPose> scans(std::size_t count) const;
  /// The trail at each step; its first point before it begins, its last after it ends. `trail` has a point.
  [[nodiscard]] std::vector<Vec2> positions(const Trail& trail) const;
  /// Begin and end of the trail as shares of the playback, each in [0, 1].
  [[nodiscard]] std::pair<double, double> stay(const Trail& trail) const;

 private:
  [[nodiscard]] Time time_of(std::size_t step) const {
    return begin_ + duration_from_seconds(lasts_s_ * static_cast<double>(step) / static_cast<double>(steps_ - 1));
  }

  const std::vector<DrivenPose>& driven_;
  Time begin_ = kNever;
  double lasts_s_ = 1.0;
  std::size_t steps_ = 2;
};

/// Where the trail was at time `t`, in a straight line between its points; its last point for 1 s after its end. No
/// value before its first point and later than that.
[[nodiscard]] std::optional<Vec2> position_at(const Trail& trail, Time t);

/// Whether pictures can be drawn: cairo is loaded when first asked for. Not for the loop.
[[nodiscard]] bool can_draw_pictures();

/// Draws the scene and writes it as a PNG about 1,900 pixels wide: walls, field, movers, drive, plan;
/// beside the map its facts and a legend. The same scene gives the same bytes on the same machine
/// (letters come from the font "DejaVu Sans" by way of cairo). Throws StartupError when `file`
/// cannot be written, or cairo is not installed.
void draw_picture(const PictureScene& scene, const std::string& file);

/// The scene as a moving picture for browsers and READMEs: SVG with SMIL animation and no script; it repeats for ever.
/// Walls, the robot with its way, goal, movers (tracks that moved where there are no movers). It plays in real time,
/// runs longer than a minute faster. Positions are 0.4 s apart, farther where the text would have more than about
/// 100 kB. The same scene gives the same text. An empty scene gives an empty map.
[[nodiscard]] std::string svg_of(const PictureScene& scene);

/// Writes svg_of(scene). Throws StartupError when `file` cannot be written.
void draw_svg(const PictureScene& scene, const std::string& file);

}  // namespace jaywalk
