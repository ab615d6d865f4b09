#pragma once
// A made-up run across a room of 16 m x 12 m, for looking at and for testing.
#include <cmath>
#include <limits>

#include "apps/report/picture/scene.h"

namespace jaywalk {

inline FieldRaster made_field(Vec2 goal) {
  FieldRaster field{{0.0, 0.0}, 160, 120, 0.1, {}};
  for (int j = 0; j < field.height; ++j) {
    for (int i = 0; i < field.width; ++i) {
      const Vec2 p{0.05 + 0.1 * i, 0.05 + 0.1 * j};
      const bool pillar = distance(p, {8.0, 5.0}) < 1.3;
      field.psi.push_back(pillar ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(distance(p, goal)));
    }
  }
  field.psi[600] = std::numeric_limits<float>::infinity();
  return field;
}

inline Trail made_trail(std::uint32_t id, Vec2 from, Vec2 velocity, int points) {
  Trail trail{id, 0.27, id == 2, {}};
  for (int i = 0; i < points; ++i) {
    const double t = 0.2 * i;
    trail.points.push_back({time_from_seconds(t), from + velocity * t + Vec2{0.0, 0.3 * sin(0.3 * t)}});
  }
  return trail;
}

inline PictureScene made_scene() {
  PictureScene scene;
  scene.title = "crossing, seed 1: goal reached";
  scene.facts = {{"outcome", "reached"}, {"path", "13.9 m"}, {"shortest", "13.2 m"}, {"time", "28.0 s"}};
  scene.walls = {{{0, 0}, {16, 0}}, {{16, 0}, {16, 12}}, {{16, 12}, {0, 12}}, {{0, 12}, {0, 0}}};
  for (int i = 0; i < 120; ++i) scene.occupied.push_back({0.05 + 0.1 * i, 0.05});
  for (int i = 0; i < 63; ++i) scene.occupied.push_back(Vec2{8.0, 5.0} + direction(0.1 * i) * 1.0);
  scene.start = Pose2{1.5, 2.0, 0.3};
  scene.goal = Vec2{14.0, 9.0};
  for (int i = 0; i <= 140; ++i) {
    const double t = 0.2 * i, s = 0.5 * t / 14.0;
    scene.driven.push_back({time_from_seconds(t), {1.5 + 12.5 * s, 2.0 + 7.0 * s * s, atan2(14.0 * s, 12.5)}});
  }
  for (std::uint32_t id = 1; id <= 5; ++id) {
    scene.movers.push_back(
        made_trail(id, {2.0 + 2.5 * id, 2.0 + 1.3 * id}, {0.15 * (id % 3) - 0.15, 0.2 - 0.1 * (id % 4)}, 140));
  }
  PlanMoment& moment = scene.moment.emplace();
  moment.t = time_from_seconds(12.0);
  moment.map_from_robot = scene.driven[60].pose;
  moment.field = made_field(*scene.goal);
  for (int i = 60; i <= 140; ++i) {
    moment.band.push_back(scene.driven[static_cast<std::size_t>(i)].pose.position() +
                          Vec2{0.0, 0.4 * sin(0.04 * (i - 60))});
  }
  for (std::uint32_t id = 1; id <= 5; ++id) {
    Track track;
    track.id = 10 + id;
    track.position_in_map = scene.movers[id - 1].points[60].position;
    moment.tracks.push_back(track);
    moment.predictions.push_back({track.id, track.position_in_map + Vec2{0.6, 0.5}, 0.57});
  }
  scene.footprint = p3dx().footprint;
  scene.extent = extent_of(scene);
  return scene;
}

}  // namespace jaywalk
