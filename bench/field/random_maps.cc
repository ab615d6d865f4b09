#include "bench/field/random_maps.h"

#include <algorithm>
#include <cstddef>

namespace jaywalk {
namespace {
using paper::CellMap;

CellMap filled(std::int32_t side, std::uint8_t value) {
  return {side, side,
          std::vector<std::uint8_t>(static_cast<std::size_t>(side) * static_cast<std::size_t>(side), value)};
}

std::uint8_t& at(CellMap& map, std::int32_t i, std::int32_t j) {
  return map.wall[static_cast<std::size_t>(j) * static_cast<std::size_t>(map.width) + static_cast<std::size_t>(i)];
}

/// Cells [i0, i1) x [j0, j1).
struct Box {
  std::int32_t i0, j0, i1, j1;
};

void set(CellMap& map, const Box& box, std::uint8_t value) {
  for (std::int32_t j = std::max(box.j0, 0); j < std::min(box.j1, map.height); ++j) {
    for (std::int32_t i = std::max(box.i0, 0); i < std::min(box.i1, map.width); ++i) at(map, i, j) = value;
  }
}

/// A wall across `room` at `place` along x or y, with a door or two; the two rooms that it makes are added.
void divide(CellMap& map, const Box& room, bool along_x, std::vector<Box>& rooms, MapRandom& random) {
  const std::int32_t width = room.i1 - room.i0, height = room.j1 - room.j0;
  const std::int32_t across = along_x ? height : width, door = 8 + random.below(10);
  const std::int32_t place = 15 + random.below((along_x ? width : height) - 30);
  const auto low = along_x ? room.i0 + place : room.j0 + place;
  set(map, along_x ? Box{low, room.j0, low + 2, room.j1} : Box{room.i0, low, room.i1, low + 2}, 1);
  for (std::int32_t doors = random.below(3) == 0 ? 2 : 1; doors > 0; --doors) {
    const std::int32_t from = 2 + random.below(std::max(1, across - door - 4)) + (along_x ? room.j0 : room.i0);
    set(map, along_x ? Box{low, from, low + 2, from + door} : Box{from, low, from + door, low + 2}, 0);
  }
  rooms.push_back(along_x ? Box{room.i0, room.j0, low, room.j1} : Box{room.i0, room.j0, room.i1, low});
  rooms.push_back(along_x ? Box{low + 2, room.j0, room.i1, room.j1} : Box{room.i0, low + 2, room.i1, room.j1});
}

CellMap rooms(std::int32_t side, MapRandom& random) {
  CellMap map = filled(side, 1);
  set(map, {1, 1, side - 1, side - 1}, 0);
  std::vector<Box> open{{0, 0, side, side}};
  while (!open.empty()) {
    const Box room = open.back();
    open.pop_back();
    const std::int32_t width = room.i1 - room.i0, height = room.j1 - room.j0, longer = std::max(width, height);
    if (longer < 40 || (longer < 90 && random.below(4) == 0)) continue;
    divide(map, room, width > height, open, random);
  }
  return map;
}

/// Rock where five or more of the nine cells about one are rock, six times over.
CellMap cave(std::int32_t side, MapRandom& random) {
  CellMap map = filled(side, 0);
  for (std::uint8_t& cell : map.wall) cell = random.below(100) < 44 ? 1 : 0;
  for (int round = 0; round < 6; ++round) {
    CellMap before = map;
    for (std::int32_t j = 0; j < side; ++j) {
      for (std::int32_t i = 0; i < side; ++i) {
        int rock = 0;
        for (std::int32_t n = 0; n < 9; ++n) {
          const std::int32_t x = i + n % 3 - 1, y = j + n / 3 - 1;
          rock += x < 0 || y < 0 || x >= side || y >= side ? 1 : at(before, x, y);
        }
        at(map, i, j) = rock >= 5 ? 1 : 0;
      }
    }
  }
  return map;
}

/// Depth-first: on from the last room to one not yet seen beside it, back where there is none.
CellMap maze(std::int32_t side, MapRandom& random) {
  const std::int32_t corridor = 8 + random.below(14), pitch = corridor + 2, rooms = side / pitch;
  CellMap map = filled(side, 1);
  std::vector<std::uint8_t> seen(static_cast<std::size_t>(rooms * rooms), 0);
  std::vector<std::int32_t> way{0};
  seen[0] = 1;
  while (!way.empty()) {
    const std::int32_t here = way.back(), x = here % rooms, y = here / rooms;
    std::vector<std::int32_t> ahead;
    const auto look = [&](bool exists, std::int32_t room) {
      if (exists && seen[static_cast<std::size_t>(room)] == 0) ahead.push_back(room);
    };
    look(x > 0, here - 1), look(x < rooms - 1, here + 1), look(y > 0, here - rooms), look(y < rooms - 1, here + rooms);
    if (ahead.empty()) {
      way.pop_back();
      continue;
    }
    const std::int32_t next = ahead[static_cast<std::size_t>(random.below(static_cast<std::int32_t>(ahead.size())))];
    const std::int32_t low = std::min(here, next), high = std::max(here, next);
    set(map,
        {low % rooms * pitch + 1, low / rooms * pitch + 1, high % rooms * pitch + 1 + corridor,
         high / rooms * pitch + 1 + corridor},
        0);
    seen[static_cast<std::size_t>(next)] = 1;
    way.push_back(next);
  }
  return map;
}

CellMap boxes(std::int32_t side, MapRandom& random) {
  CellMap map = filled(side, 0);
  const std::int32_t count = random.below(300), longest = 2 + random.below(40);
  for (std::int32_t k = 0; k < count; ++k) {
    const std::int32_t i = random.below(side), j = random.below(side);
    const std::int32_t width = 1 + random.below(longest), height = 1 + random.below(longest);
    set(map, {i, j, i + width, j + height}, 1);
  }
  return map;
}

struct Kind {
  const char* name;
  CellMap (*map)(std::int32_t side, MapRandom& random);
};
constexpr Kind kKinds[] = {{"rooms", rooms}, {"cave", cave}, {"maze", maze}, {"boxes", boxes}};  // as MapKind has them

}  // namespace

std::int32_t MapRandom::below(std::int32_t n) {
  state_ ^= state_ << 13;
  state_ ^= state_ >> 7;
  state_ ^= state_ << 17;
  return static_cast<std::int32_t>((state_ >> 32) % static_cast<std::uint64_t>(n));
}

const char* name_of(MapKind kind) { return kKinds[static_cast<std::size_t>(kind)].name; }

CellMap random_map(MapKind kind, std::int32_t side, MapRandom& random) {
  return kKinds[static_cast<std::size_t>(kind)].map(side, random);
}

}  // namespace jaywalk
