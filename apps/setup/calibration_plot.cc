#include "apps/setup/calibration_plot.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>

namespace jaywalk {
namespace {

constexpr double kSide = 360.0, kMargin = 50.0;
constexpr const char* kBelieved = "#b0b0b0";
constexpr const char* kFoundColour = "#1f5fbf";

/// A square panel, `most` of its unit from its middle to its edge.
class Panel {
 public:
  Panel(double left, double most) : left_(left), most_(most) {}

  [[nodiscard]] std::string frame(const std::string& title) const {
    char text[400];
    std::snprintf(text, sizeof text,
                  "<rect x='%.0f' y='%.0f' width='%.0f' height='%.0f' fill='none' stroke='#888'/>"
                  "<path d='M%.0f %.0fh%.0fM%.0f %.0fv%.0f' stroke='#ddd'/>"
                  "<text x='%.0f' y='%.0f'>%s, to %.3g at the rim</text>\n",
                  left_, kMargin, kSide, kSide, left_, kMargin + 0.5 * kSide, kSide, left_ + 0.5 * kSide, kMargin,
                  kSide, left_, kMargin - 12.0, title.c_str(), most_);
    return text;
  }
  [[nodiscard]] std::string dot(double x, double y, const char* colour) const {
    const auto inside = [this](double value) { return 0.5 * kSide * std::clamp(value / most_, -1.0, 1.0); };
    char text[120];
    std::snprintf(text, sizeof text, "<circle cx='%.1f' cy='%.1f' r='3' fill='%s'/>\n", left_ + 0.5 * kSide + inside(x),
                  kMargin + 0.5 * kSide - inside(y), colour);
    return text;
  }
  [[nodiscard]] double most() const { return most_; }

 private:
  double left_, most_;
};

double greatest(const Calibration& calibration, const std::function<double(const MotionResidual&)>& of) {
  double most = 1e-6;
  for (const auto* residuals : {&calibration.before, &calibration.after})
    for (const MotionResidual& each : *residuals) most = std::max(most, of(each));
  return most;
}

}  // namespace

std::string svg_of(const Calibration& calibration) {
  const Panel ways(kMargin, 1e3 * greatest(calibration, [](const MotionResidual& r) {
                              return std::max(std::fabs(r.x_m), std::fabs(r.y_m));
                            }));
  const Panel turns(2.0 * kMargin + kSide,
                    1e3 * greatest(calibration, [](const MotionResidual& r) { return std::fabs(r.turn_rad); }));
  char head[200];
  std::snprintf(head, sizeof head,
                "<svg xmlns='http://www.w3.org/2000/svg' width='%.0f' height='%.0f' font-family='sans-serif' "
                "font-size='13'>\n<rect width='100%%' height='100%%' fill='white'/>\n",
                3.0 * kMargin + 2.0 * kSide, 2.0 * kMargin + kSide);
  std::string svg = head + ways.frame("wheels less scans: x, y (mm)") + turns.frame("turn (mrad), by motion");
  for (const auto& [residuals, colour] :
       {std::pair{&calibration.before, kBelieved}, std::pair{&calibration.after, kFoundColour}}) {
    for (std::size_t k = 0; k < residuals->size(); ++k) {
      const MotionResidual& r = (*residuals)[k];
      const double along = 2.0 * static_cast<double>(k + 1) / static_cast<double>(residuals->size() + 1) - 1.0;
      svg += ways.dot(1e3 * r.x_m, 1e3 * r.y_m, colour) + turns.dot(along * turns.most(), 1e3 * r.turn_rad, colour);
    }
  }
  char foot[120];
  std::snprintf(foot, sizeof foot, "<text x='%.0f' y='%.0f'>grey: as believed; blue: as found</text>\n</svg>\n",
                kMargin, kSide + 2.0 * kMargin - 18.0);
  return svg + foot;
}

}  // namespace jaywalk
