#pragma once
// What stands where: evidence for "occupied" against "free", a cell of the world at a time.
#include <cstdint>
#include <vector>

#include "hal/types/geometry.h"

namespace jaywalk {
/// Index of a world cell: cell (i, j) covers [i, i+1) x [j, j+1) times the cell size, in the map.
struct CellIndex {
  std::int32_t i = 0;
  std::int32_t j = 0;
  constexpr bool operator==(const CellIndex&) const = default;
};

/// A square window of the world that rolls with the robot, stored as a torus: moving it costs only the cells that
/// enter. What leaves is forgotten.
///
/// Evidence is log odds in units of 1/16 nat: positive speaks for occupied, 0 is unknown, and both ends saturate so
/// that the map can change its mind within a few scans. A cell that holds a surface also remembers where in it the
/// laser's points fall, to 1/128 of half a cell, from where it was seen (a wall has two faces), and for how long: a
/// slow pedestrian leaves a new surface in every cell, a wall an old one.
/// Memory: a little more than 6 * side * side bytes, taken in the constructor. Not thread-safe.
class EvidenceMap {
 public:
  struct Offset {
    std::int8_t x = 0, y = 0;
    constexpr bool operator==(const Offset&) const = default;
  };

  /// `side_cells` is a power of two; `cell_m` > 0. The window is centred on `centre_in_map`.
  EvidenceMap(std::int32_t side_cells, double cell_m, Vec2 centre_in_map)
      : side_(side_cells),
        cell_m_(cell_m),
        evidence_(static_cast<std::size_t>(side_cells) * static_cast<std::size_t>(side_cells), 0),
        seen_for_(evidence_.size(), 0),
        surface_(evidence_.size()),
        to_laser_(evidence_.size()),
        changed_(evidence_.size() / kPiece) {
    const CellIndex centre = cell_at(centre_in_map);
    low_ = {centre.i - side_ / 2, centre.j - side_ / 2};
  }

  [[nodiscard]] std::int32_t side() const { return side_; }
  [[nodiscard]] double cell_m() const { return cell_m_; }
  /// Beyond 500 million cells from the origin the last one there; what is not a number is in the first.
  [[nodiscard]] CellIndex cell_at(Vec2 p_in_map) const {
    return {whole_cells(p_in_map.x / cell_m_), whole_cells(p_in_map.y / cell_m_)};
  }
  [[nodiscard]] Vec2 centre_of(CellIndex cell) const { return {(cell.i + 0.5) * cell_m_, (cell.j + 0.5) * cell_m_}; }
  /// The window's lowest cell.
  [[nodiscard]] CellIndex low() const { return low_; }
  [[nodiscard]] bool contains(CellIndex cell) const { return within(cell.i, low_.i) && within(cell.j, low_.j); }

  /// Where a cell has its place on the torus, row by row, below side * side: for what others keep a cell.
  [[nodiscard]] std::size_t slot(CellIndex cell) const {
    const auto mask = static_cast<std::uint32_t>(side_ - 1);
    return static_cast<std::size_t>(static_cast<std::uint32_t>(cell.j) & mask) * static_cast<std::size_t>(side_) +
           (static_cast<std::uint32_t>(cell.i) & mask);
  }

  /// Evidence of a cell; 0 (unknown) outside the window.
  [[nodiscard]] std::int8_t evidence(CellIndex cell) const {
    return contains(cell) ? evidence_[slot(cell)] : std::int8_t{0};
  }
  /// The evidence of `n` cells from `first` on eastwards, as evidence() has it: many at a time.
  void copy_row(CellIndex first, std::int32_t n, std::int8_t* to) const noexcept {
    copy_row_of(evidence_, first, n, to);
  }
  [[nodiscard]] bool occupied(CellIndex cell) const { return evidence(cell) > kOccupied; }
  [[nodiscard]] bool seen_free(CellIndex cell) const { return evidence(cell) < kFree; }
  /// Occupied, and hits were seen for kStandsAfterS of scans: longer than a walker stays in a cell.
  [[nodiscard]] bool stands(CellIndex cell) const {
    return occupied(cell) && seen_for_[slot(cell)] >= kSeenUnitsPerS * kStandsAfterS;
  }

  /// The same of where surfaces lie in their cells, as they are kept: for telling whether any has moved. Outside the
  /// window 0; meaningless likewise for cells that are not occupied.
  void copy_row_of_surfaces(CellIndex first, std::int32_t n, Offset* to) const noexcept {
    copy_row_of(surface_, first, n, to);
  }

  /// Becomes as `from` is, of the same side. Where it is a copy that has followed the same map before, and nothing else
  /// has changed it, what has changed since is copied, 64 cells at a time.
  void follow(const EvidenceMap& from) noexcept;

  /// Adds to a cell's evidence, saturating in [kMin, kMax]; nothing happens outside the window.
  void add(CellIndex cell, int change) noexcept;
  /// A laser's point: adds `change` to its cell's evidence, and the point to the cell's surface point, a running
  /// mean of about eight points that starts anew where the cell was not held occupied. `seen_for_s` >= 0, of which at
  /// most 0.25 s count: since the scan before. `to_laser` has length 1, or 0 where nobody knows.
  void add_hit(Vec2 p_in_map, int change, double seen_for_s = 0.0, Vec2 to_laser = {}) noexcept;
  /// A map from before says what is in the cell: evidence, and of a wall that it stands there for long, its surface at
  /// `surface_in_map` in this cell until the first hit says where. `free_side`: the side that it is seen from, by the
  /// signs of its coordinates; 0 where it may be any.
  void tell(CellIndex cell, int evidence, Vec2 surface_in_map, Vec2 free_side = {}) noexcept;
  /// Where the surface in an occupied cell lies (m, in the map): the mean of its recent points. The cell's centre
  /// where nothing but add() was called. Meaningless for cells that are not occupied.
  [[nodiscard]] Vec2 surface(CellIndex cell) const {
    const Offset& offset = surface_[slot(cell)];
    return centre_of(cell) + Vec2{offset.x * 1.0, offset.y * 1.0} * (0.5 * cell_m_ / 128.0);
  }
  /// Which way the lasers were that saw it: a mean of unit vectors, 0 where nobody knows. Meaningless likewise.
  [[nodiscard]] Vec2 to_laser(CellIndex cell) const;
  /// As if the cell had never been seen; nothing happens outside the window.
  void forget(CellIndex cell) noexcept {
    if (!contains(cell)) return;
    const std::size_t k = slot(cell);
    evidence_[k] = 0;
    seen_for_[k] = 0;
    surface_[k] = {};
    to_laser_[k] = {};
    note_change(k);
  }
  /// Rolls the window, unless it is centred within a quarter side of `centre_in_map`. Cells that enter are unknown.
  void roll_to(Vec2 centre_in_map) noexcept;

  static constexpr int kMin = -64, kMax = 64;
  static constexpr int kOccupied = 16;  ///< above: treated as an obstacle
  static constexpr int kFree = -16;     ///< below: has been seen free
  static constexpr double kStandsAfterS = 1.0;

 private:
  static constexpr double kSeenUnitsPerS = 250.0;  ///< fits a byte; a scan at 40 Hz is 6 of them, not 6.25

  /// Rounded down and held within kFarthest: a number that no integer holds becomes another one on each processor.
  /// Not std::floor, which is a call without SSE 4.1: this is asked ten thousand times a scan.
  static std::int32_t whole_cells(double cells) {
    constexpr double kFarthest = 5e8;  // the sum of two differences of such still is an integer
    const double not_below = cells > -kFarthest ? cells : -kFarthest,
                 held = not_below < kFarthest ? not_below : kFarthest;
    const auto towards_zero = static_cast<std::int32_t>(held);
    return held < towards_zero ? towards_zero - 1 : towards_zero;
  }
  /// Whether `at` lies in [low, low + side): in unsigned numbers what is below is far above.
  [[nodiscard]] bool within(std::int32_t at, std::int32_t low) const {
    return static_cast<std::uint32_t>(at) - static_cast<std::uint32_t>(low) < static_cast<std::uint32_t>(side_);
  }
  template <class T>
  void copy_row_of(const std::vector<T>& values, CellIndex first, std::int32_t n, T* to) const noexcept {
    std::fill_n(to, n, T{});
    if (!within(first.j, low_.j)) return;
    const std::int32_t end = std::min(first.i + n, low_.i + side_);
    for (std::int32_t i = std::max(first.i, low_.i); i < end;) {  // a piece up to where the torus closes
      const std::size_t from = slot({i, first.j});
      const std::int32_t to_seam = side_ - static_cast<std::int32_t>(from % static_cast<std::size_t>(side_));
      const std::int32_t piece = std::min(end - i, to_seam);
      std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(from), piece, to + (i - first.i));
      i += piece;
    }
  }
  void note_change(std::size_t k) noexcept { changed_[k / kPiece] = ++changes_; }

  static constexpr std::size_t kPiece = 64;
  static constexpr std::int8_t kToldOnly = -128;  ///< to_laser's x: no hit has been there; y is the free side's code
  std::int32_t side_;
  double cell_m_;
  CellIndex low_;
  std::vector<std::int8_t> evidence_;
  std::vector<std::uint8_t> seen_for_;  ///< in 1/250 s, saturating; 0 where it is not held occupied
  std::vector<Offset> surface_;         ///< from the cell's centre, in 1/128 of half a cell
  std::vector<Offset> to_laser_;        ///< in 1/127
  std::uint64_t changes_ = 0;           ///< so far
  std::vector<std::uint64_t> changed_;  ///< at which change a piece of 64 cells did last
  const EvidenceMap* followed_ = nullptr;
};

/// Calls `visit` with places (in the map) all along what stands within `reach_m` of a place, each axis: every surface
/// of a cell that `counts`, and between those of cells that touch, so that none are farther than 4 cm apart.
template <class Counts, class Visit>
void for_each_surface_near(const EvidenceMap& still, Vec2 place, double reach_m, Counts&& counts, Visit&& visit) {
  constexpr int kPieces = 4;
  const Vec2 reach{reach_m, reach_m};
  const CellIndex first = still.cell_at(place - reach), last = still.cell_at(place + reach);
  for (std::int32_t j = first.j; j <= last.j; ++j) {
    for (std::int32_t i = first.i; i <= last.i; ++i) {
      if (!counts(CellIndex{i, j})) continue;
      const Vec2 here = still.surface({i, j});
      visit(here);
      for (const CellIndex beside : {CellIndex{i + 1, j}, {i, j + 1}, {i + 1, j + 1}, {i - 1, j + 1}}) {
        if (!counts(beside)) continue;
        const Vec2 piece = (still.surface(beside) - here) * (1.0 / kPieces);
        for (int k = 1; k < kPieces; ++k) visit(here + piece * k);
      }
    }
  }
}

}  // namespace jaywalk
