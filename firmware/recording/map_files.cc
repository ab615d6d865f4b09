#include "firmware/recording/map_files.h"

#include <algorithm>
#include <cstdio>
#include <string>

#include "hal/text_file.h"

namespace jaywalk {
namespace {

// What map_saver of ROS writes in its mode "trinary".
constexpr char kOccupied = 0;
constexpr auto kFree = static_cast<char>(254), kUnknown = static_cast<char>(205);
constexpr const char* kThresholds = "mode: trinary\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n";
constexpr const char* kAnotherFolder = "choose another --out folder";

/// Both ends belong to it.
struct CellBox {
  CellIndex low, high;
};

char shade_of(const EvidenceMap& map, CellIndex cell) {
  if (map.occupied(cell)) return kOccupied;
  return map.seen_free(cell) ? kFree : kUnknown;
}

/// The box of all cells that are known; the window's lowest cell where none is.
CellBox known_cells(const EvidenceMap& map) {
  const CellIndex first = map.low(), last{first.i + map.side() - 1, first.j + map.side() - 1};
  CellBox box{last, first};
  for (std::int32_t j = first.j; j <= last.j; ++j) {
    for (std::int32_t i = first.i; i <= last.i; ++i) {
      if (shade_of(map, {i, j}) == kUnknown) continue;
      box.low = {std::min(box.low.i, i), std::min(box.low.j, j)};
      box.high = {std::max(box.high.i, i), std::max(box.high.j, j)};
    }
  }
  return box.high.i < box.low.i ? CellBox{first, first} : box;
}

std::string pgm_of(const EvidenceMap& map, const CellBox& box) {
  std::string bytes = "P5\n" + std::to_string(box.high.i - box.low.i + 1) + " " +
                      std::to_string(box.high.j - box.low.j + 1) + "\n255\n";
  for (std::int32_t j = box.high.j; j >= box.low.j; --j) {
    for (std::int32_t i = box.low.i; i <= box.high.i; ++i) bytes += shade_of(map, {i, j});
  }
  return bytes;
}

}  // namespace

void save_map(const EvidenceMap& map, const std::filesystem::path& folder) {
  const CellBox box = known_cells(map);
  write_text(folder / "map.pgm", pgm_of(map, box), kAnotherFolder);
  char place[160];  // of the lower left pixel's lower left corner, in the map
  std::snprintf(place, sizeof place, "image: map.pgm\nresolution: %.6g\norigin: [%.6f, %.6f, 0.0]\n", map.cell_m(),
                box.low.i * map.cell_m(), box.low.j * map.cell_m());
  write_text(folder / "map.yaml", std::string(place) + kThresholds, kAnotherFolder);
}

}  // namespace jaywalk
