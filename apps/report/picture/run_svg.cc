#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

#include "apps/report/markup.h"
#include "apps/report/picture/run_layers.h"
#include "apps/report/picture/scene.h"
#include "hal/shown_text.h"
#include "hal/text_file.h"

namespace jaywalk {
namespace {
constexpr Vec2 kDrawingCorner{20.0, 80.0},
    kDrawingMost{1600.0, 1400.0};  // units of the drawing; 1600 across 25 m: 1.6 cm each
constexpr double kDrawingFoot = 60.0;
constexpr double kLongestPlayS = 60.0;
constexpr std::size_t kMostPositions = 4'000;  ///< at about 10 bytes each
constexpr std::size_t kMostPieces = 1'500;     ///< of walls and rows of cells, at about 18 bytes each
constexpr std::size_t kMostBodies = 80;        ///< each has about 500 bytes beside its positions
constexpr std::size_t kMostScans = 60;         ///< at about 400 bytes each
constexpr std::size_t kMostWalls = 1'000;      ///< more are passed through: each is looked at some ten thousand times
constexpr double kAhead_s = 2.0;               ///< for which a body is expected to go straight on
constexpr double kRadiansPerDegree = 0.017453292519943295;

/// Nearest whole number, as text: whole units keep the file small.
std::string whole(double value) { return std::to_string(std::lround(value)); }

std::string pair(Vec2 p) { return whole(p.x) + " " + whole(p.y); }

/// `text` as XML's characters: '?' for each byte outside printable ASCII.
std::string escaped(std::string text) {
  std::ranges::replace_if(
      text, [](char c) { return c < ' ' || c > '~'; }, '?');
  return as_markup(text);
}

/// "#rrggbb"; opacity is left out.
std::string hex(const Colour& colour) {
  const auto byte = [](double part) { return static_cast<unsigned>(std::lround(part * 255.0)); };
  return formatted("#%02x%02x%02x", byte(colour.red), byte(colour.green), byte(colour.blue));
}

/// Words of `values`; those of an animation are separated by ';'.
template <class Values, class Word>
std::string joined(const Values& values, const Word& word, const char* between = ";") {
  std::string out;
  for (const auto& value : values) out += (out.empty() ? "" : between) + word(value);
  return out;
}

/// A line through all points.
std::string path_of(const std::vector<Vec2>& points, const MapFrame& to_sheet) {
  return "M" + joined(
                   points, [&](Vec2 p) { return pair(to_sheet(p)); }, " ");
}

class Drawing {
 public:
  explicit Drawing(const PictureScene& scene)
      : scene_(scene),
        to_sheet_(scene.extent, kDrawingCorner, kDrawingMost),
        bodies_(shown_bodies()),
        playback_(scene.driven, kMostPositions / (1 + 2 * bodies_.size())) {}

  std::string text() {
    begin();
    zones();
    laser();
    walls();
    goal();
    way();
    for (const Trail* trail : bodies_) body(*trail);
    robot();
    clock();
    return out_ + "</svg>\n";
  }

 private:
  /// Movers, else tracks that moved; the longest trails where there are too many.
  [[nodiscard]] std::vector<const Trail*> shown_bodies() const {
    std::vector<const Trail*> all;
    for (const Trail& trail : scene_.movers.empty() ? scene_.tracks : scene_.movers)
      if (scene_.movers.empty() ? went_somewhere(trail) : !trail.points.empty()) all.push_back(&trail);
    std::ranges::stable_sort(all, std::greater(), [](const Trail* trail) { return trail->points.size(); });
    if (all.size() > kMostBodies) all.resize(kMostBodies);
    return all;
  }

  [[nodiscard]] double play_s() const { return std::min(playback_.lasts_s(), kLongestPlayS); }

  [[nodiscard]] std::string dur() const { return formatted(" dur=\"%.1fs\" repeatCount=\"indefinite\"/>", play_s()); }

  void begin() {
    const Vec2 size = to_sheet_.size();
    const std::string width = whole(size.x + 2.0 * kDrawingCorner.x),
                      height = whole(kDrawingCorner.y + size.y + kDrawingFoot);
    out_ = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + width + " " + height +
           "\" font-family=\"DejaVu Sans,sans-serif\" font-size=\"30\" fill=\"" + hex(ink::kText) + "\">\n" +
           "<rect width=\"" + width + "\" height=\"" + height + "\" fill=\"#fff\"/>\n<text x=\"20\" y=\"50\">" +
           escaped(scene_.title) + "</text>\n";
  }

  void zones() {
    for (const MapZone& zone : scene_.zones) {
      const std::string colour = hex(colour_of(zone.kind));
      out_ += "<path class=\"zone\" d=\"" + path_of(zone.corners, to_sheet_) + "Z\" fill=\"" + colour +
              "\" fill-opacity=\".18\" stroke=\"" + colour + "\" stroke-width=\"3\" stroke-dasharray=\"12\"/>\n";
    }
  }

  /// Rows of neighbouring cells as one stroke each; coarser where these are too many.
  [[nodiscard]] std::string cells(int coarser) const {
    const double size = scene_.cell_m * coarser;
    std::set<std::pair<long, long>> rows;  // (row, column)
    for (const Vec2 c : scene_.occupied) rows.insert({std::lround(c.y / size - 0.5), std::lround(c.x / size - 0.5)});
    std::string path;
    std::size_t pieces = 0;
    for (auto cell = rows.begin(); cell != rows.end();) {
      const auto first = *cell;
      long last = first.second;
      while (++cell != rows.end() && cell->first == first.first && cell->second == last + 1) ++last;
      const Vec2 from{size * static_cast<double>(first.second), size * (static_cast<double>(first.first) + 0.5)};
      const double wide = size * static_cast<double>(last + 1 - first.second);
      path += "M" + pair(to_sheet_(from)) + "h" + whole(std::max(to_sheet_.pixels(wide), 1.0));
      ++pieces;
    }
    if (pieces > kMostPieces) return cells(2 * coarser);
    return stroke(path, ink::kSeen, std::max(to_sheet_.pixels(size), 2.0));
  }

  void walls() {
    std::string path;
    const std::size_t each = 1 + scene_.walls.size() / kMostPieces;
    for (std::size_t i = 0; i < scene_.walls.size(); i += each) {
      path += "M" + pair(to_sheet_(scene_.walls[i].from)) + "L" + pair(to_sheet_(scene_.walls[i].to));
    }
    out_ += scene_.walls.empty() ? cells(1) : stroke(path, ink::kSeen, 6.0);
  }

  [[nodiscard]] static std::string stroke(const std::string& path, const Colour& colour, double width) {
    return "<path d=\"" + path + "\" fill=\"none\" stroke=\"" + hex(colour) + "\" stroke-width=\"" + whole(width) +
           "\"/>\n";
  }

  void goal() {
    if (!scene_.goal) return;
    const Vec2 at = to_sheet_(*scene_.goal);
    out_ += "<circle id=\"goal\" cx=\"" + whole(at.x) + "\" cy=\"" + whole(at.y) + "\" r=\"" +
            whole(std::max(to_sheet_.pixels(scene_.goal_tolerance_m), 8.0)) + "\" fill=\"" + hex(ink::kGoal) +
            "\" fill-opacity=\".3\" stroke=\"" + hex(ink::kGoal) + "\" stroke-width=\"5\"/>\n";
  }

  /// Grows with the robot: each step uncovers the share of the way that was driven by then.
  void way() {
    const std::vector<Pose2> poses = playback_.robot();
    if (poses.empty()) return;
    std::vector<Vec2> line;
    std::vector<double> driven{0.0};
    for (const Pose2& pose : poses) {
      if (!line.empty()) driven.push_back(driven.back() + distance(line.back(), pose.position()));
      line.push_back(pose.position());
    }
    if (!(driven.back() > 0.0)) return;
    const auto left = [&](double d) { return whole(1000.0 * (1.0 - d / driven.back())); };
    out_ += "<path d=\"" + path_of(line, to_sheet_) + "\" fill=\"none\" stroke=\"" + hex(ink::kRobot) +
            "\" stroke-width=\"6\" pathLength=\"1000\" stroke-dasharray=\"1000\"><animate "
            "attributeName=\"stroke-dashoffset\" values=\"" +
            joined(driven, left) + "\"" + dur() + "</path>\n";
  }

  void robot() {
    const std::vector<Pose2> poses = playback_.robot();
    if (poses.empty()) return;
    const auto place = [&](const Pose2& p) { return pair(to_sheet_(p.position())); };
    const auto turn = [](const Pose2& p) { return whole(-p.heading / kRadiansPerDegree); };
    const Footprint& f = scene_.footprint;
    const auto u = [&](double metres) { return whole(to_sheet_.pixels(metres)); };
    out_ += "<g id=\"robot\" transform=\"translate(" + place(poses.back()) + ")\">" + moved(poses, place) +
            "<g transform=\"rotate(" + turn(poses.back()) + ")\"><animateTransform attributeName=\"transform\" " +
            "type=\"rotate\" values=\"" + joined(poses, turn) + "\"" + dur() + "<path d=\"M" + u(f.front_m) + " " +
            u(-f.half_width_m) + "V" + u(f.half_width_m) + "H" + u(-f.rear_m) + "V" + u(-f.half_width_m) + "ZM0 0H" +
            u(f.front_m) + "\" fill=\"" + hex(ink::kRobot) +
            "\" fill-opacity=\".6\" stroke=\"#fff\" stroke-width=\"3\"/></g></g>\n";
  }

  /// Ground that the beams pass over.
  void laser() {
    const std::vector<DrivenPose> scans = playback_.scans(kMostScans);
    if (scans.empty()) return;
    const auto ground = [&](const DrivenPose& scan) {
      const Pose2 map_from_laser = scan.pose * scene_.robot_from_laser;
      std::vector<Vec2> corners{map_from_laser.position()};
      for (const Vec2 end : scan.seen) corners.push_back(map_from_laser * end);
      return path_of(corners, to_sheet_) + "Z";
    };
    out_ += "<path id=\"laser\" d=\"" + ground(scans.back()) + "\" fill=\"" + hex(ink::kRobot) +
            "\" fill-opacity=\".1\"><animate attributeName=\"d\" calcMode=\"discrete\" values=\"" +
            joined(scans, ground) + "\"" + dur() + "</path>\n";
  }

  /// A way on the sheet, where y points down.
  [[nodiscard]] Vec2 on_sheet(Vec2 way) const { return {to_sheet_.pixels(way.x), -to_sheet_.pixels(way.y)}; }

  template <class Places, class Place>
  [[nodiscard]] std::string moved(const Places& places, const Place& place) const {
    return "<animateTransform attributeName=\"transform\" type=\"translate\" values=\"" + joined(places, place) + "\"" +
           dur();
  }

  void body(const Trail& trail) {
    const std::vector<Vec2> way = playback_.positions(trail), ahead = ways_ahead(way, trail.radius_m);
    const auto place = [&](Vec2 p) { return pair(to_sheet_(p)); };
    const auto moved_by = [&](Vec2 d) { return pair(on_sheet(d)); };
    const std::string radius = whole(to_sheet_.pixels(std::max(trail.radius_m, 0.1)));
    const std::string disc = "<circle r=\"" + radius + "\" fill=\"" + hex(colour_of(trail.id)) + "\"";
    out_ += "<g transform=\"translate(" + place(way.back()) + ")\">" + moved(way, place) + shown_while_there(trail) +
            disc + " class=\"expected\" fill-opacity=\".3\">" + moved(ahead, moved_by) + "</circle>" + disc +
            "/><text font-size=\"22\" x=\"" + radius + "\">" + std::to_string(trail.id) + "</text></g>\n";
  }

  /// At each step the way that a body goes in kAhead_s, straight on from the step before, to a wall at most.
  [[nodiscard]] std::vector<Vec2> ways_ahead(const std::vector<Vec2>& way, double radius_m) const {
    std::vector<Vec2> ahead(way.size());
    const double steps = kAhead_s / playback_.lasts_s() * static_cast<double>(way.size() - 1);
    for (std::size_t k = 1; k < way.size(); ++k) {
      const Vec2 end = way[k] + (way[k] - way[k - 1]) * steps;
      const bool few = !scene_.walls.empty() && scene_.walls.size() <= kMostWalls;
      ahead[k] = (few ? end_before_wall(scene_, way[k], end, radius_m) : end) - way[k];
    }
    return ahead;
  }

  /// Bodies that come and go are invisible before and after.
  [[nodiscard]] std::string shown_while_there(const Trail& trail) const {
    const auto [from, to] = playback_.stay(trail);
    if (from <= 0.0 && to >= 1.0) return "";
    const std::string times = formatted("0;%.4f;%.4f", std::max(from, 0.0001), std::max(to, 0.0002));
    return "<animate attributeName=\"visibility\" calcMode=\"discrete\" values=\"" +
           std::string(from <= 0.0 ? "visible" : "hidden") + ";visible;" + (to < 1.0 ? "hidden" : "visible") +
           "\" keyTimes=\"" + times + "\"" + dur();
  }

  /// A bar that grows with the time, its seconds, and how long the run was.
  void clock() {
    const double wide = to_sheet_.size().x;
    const double y = kDrawingCorner.y + to_sheet_.size().y;
    const double faster = playback_.lasts_s() / play_s();
    const std::string words =
        formatted(faster > 1.0 ? "%.1f s, shown %.1f times faster" : "%.1f s", playback_.lasts_s(), faster);
    out_ += "<rect x=\"20\" y=\"" + whole(y + 8.0) + "\" width=\"" + whole(wide) + "\" height=\"8\" fill=\"" +
            hex(ink::kFaint) + "\"><animate attributeName=\"width\" values=\"0;" + whole(wide) + "\"" + dur() +
            "</rect>\n<text x=\"20\" y=\"" + whole(y + 48.0) + "\">" + words + "</text>\n";
    for (const double share : {0.5, 0.75, 1.0})
      out_ += "<text x=\"" + whole(20.0 + share * wide) + "\" y=\"" + whole(y + 48.0) + "\" text-anchor=\"end\">" +
              whole(share * playback_.lasts_s()) + " s</text>\n";
  }

  const PictureScene& scene_;
  MapFrame to_sheet_;
  std::vector<const Trail*> bodies_;
  Playback playback_;
  std::string out_;
};

}  // namespace

std::string svg_of(const PictureScene& scene) { return Drawing(scene).text(); }

void draw_svg(const PictureScene& scene, const std::string& file) {
  write_text(file, svg_of(scene), "free some disk, or choose another --out folder");
}

}  // namespace jaywalk
