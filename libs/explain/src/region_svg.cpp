#include "kith/explain/region_svg.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "kith/core/math.hpp"
#include "kith/explain/wrapped.hpp"
#include "kith/geometry/cone_sampler.hpp"

namespace kith {
namespace {

constexpr const char* kPale = "#dfe8f2";
constexpr const char* kDark = "#5b8db8";
constexpr const char* kRobot = "#d55e00";
constexpr const char* kMuted = "#57606a";

Eigen::Vector3d in_space(const IntegerVector& v) {
  return Eigen::Vector3d{static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])}.normalized();
}

// The visible half of the sphere, seen along an axis.
class Sphere {
 public:
  Sphere(const RegionPicture& picture, double radius) : picture_{picture}, radius_{radius} {
    toward_ = in_space(picture.robot);
    Eigen::Vector3d up = Eigen::Vector3d::UnitZ() - toward_.z() * toward_;
    if (up.norm() < 0.2) up = Eigen::Vector3d::UnitY() - toward_.y() * toward_;
    up_ = up.normalized();
    right_ = up_.cross(toward_);
  }

  Svg drawn() {
    svg_.add("circle", {{"cx", "0"}, {"cy", "0"}, {"r", svg_number(radius_)}, {"fill", "#fafbfc"}});
    fill(picture_.prior, kPale);
    fill(picture_.region, kDark);
    const auto facets = picture_.region.facets();
    for (std::size_t i = 0; i < facets.size(); ++i) great_circle(facets[i].unit_normal(), std::to_string(i + 1));
    svg_.add("circle", {{"cx", "0"},
                        {"cy", "0"},
                        {"r", svg_number(radius_)},
                        {"fill", "none"},
                        {"stroke", kMuted},
                        {"stroke-width", "1.5"}});
    for (int k = 0; k < 3; ++k)
      for (const double sign : {1.0, -1.0}) axis(k, sign);
    svg_.add("circle", {{"cx", "0"}, {"cy", "0"}, {"r", "5"}, {"fill", kRobot}, {"stroke", "#ffffff"}});
    return svg_;
  }

 private:
  struct Point {
    double x = 0.0, y = 0.0;
  };
  [[nodiscard]] Point seen(const Eigen::Vector3d& w) const { return {radius_ * right_.dot(w), -radius_ * up_.dot(w)}; }
  [[nodiscard]] bool in_front(const Eigen::Vector3d& w) const { return toward_.dot(w) >= -1e-9; }

  // Fills the part of the cone on the visible half: its boundary as the end of geodesics from an inner point.
  void fill(const Cone& cone, const std::string& color) {
    auto visible = cone;
    if (!visible.clip(HalfSpace{picture_.robot})) return;
    const auto inside = in_space(visible.interior_direction());
    const Eigen::Vector3d a = inside.unitOrthogonal();
    const Eigen::Vector3d b = inside.cross(a);

    // The border in many directions from a point inside, and exactly at the corners.
    std::vector<double> angles;
    constexpr int kSteps = 720;
    for (int i = 0; i < kSteps; ++i) angles.push_back(2.0 * std::numbers::pi * i / kSteps - std::numbers::pi);
    for (const auto& ray : visible.generators()) {
      const auto corner = in_space(ray);
      angles.push_back(math::atan2(b.dot(corner), a.dot(corner)));
    }
    std::sort(angles.begin(), angles.end());

    std::string path;
    for (const double angle : angles) {
      const Eigen::Vector3d toward = math::cos(angle) * a + math::sin(angle) * b;
      double reach = std::numbers::pi;
      for (const auto& facet : visible.facets()) {
        const auto& n = facet.unit_normal();
        reach = std::min(reach, math::atan2(n.dot(inside), -n.dot(toward)));
      }
      const auto point = seen(math::cos(reach) * inside + math::sin(reach) * toward);
      path += fmt::format("{}{} {}", path.empty() ? "M" : "L", svg_number(point.x), svg_number(point.y));
    }
    svg_.add("path", {{"d", path + "Z"}, {"fill", color}});
  }

  // The visible half of the boundary of a half-space, with its number where it leaves the disc.
  void great_circle(const Eigen::Vector3d& normal, const std::string& number) {
    Eigen::Vector3d start = normal.cross(toward_);
    if (start.norm() < 1e-9) return;  // the rim itself
    start.normalize();
    const Eigen::Vector3d middle = start.cross(normal);
    const double side = middle.dot(toward_) >= 0.0 ? 1.0 : -1.0;
    std::string path;
    constexpr int kSteps = 90;
    for (int i = 0; i <= kSteps; ++i) {
      const double angle = std::numbers::pi * i / kSteps;
      const auto point = seen(math::cos(angle) * start + side * math::sin(angle) * middle);
      path += fmt::format("{}{} {}", path.empty() ? "M" : "L", svg_number(point.x), svg_number(point.y));
    }
    svg_.add("path", {{"d", path}, {"fill", "none"}, {"stroke", "#0b2f52"}, {"stroke-width", "1.4"}});
    const auto end = seen(start);
    svg_.text(1.07 * end.x, 1.07 * end.y + 4.5, number,
              {{"text-anchor", "middle"}, {"font-weight", "bold"}, {"fill", "#0b2f52"}});
  }

  // Where only one feature counts.
  void axis(int k, double sign) {
    const Eigen::Vector3d w = sign * Eigen::Vector3d::Unit(k);
    if (!in_front(w)) return;
    const auto at = seen(w);
    svg_.add("circle", {{"cx", svg_number(at.x)}, {"cy", svg_number(at.y)}, {"r", "3"}, {"fill", kMuted}});
    const bool left = at.x < 0.0;
    const auto name =
        fmt::format("{}{}", sign > 0 ? "+" : "\xE2\x88\x92", picture_.features[static_cast<std::size_t>(k)]);
    svg_.text(at.x + (left ? -7 : 7), at.y - 6, name,
              {{"text-anchor", left ? "end" : "start"},
               {"font-size", "12"},
               {"fill", kMuted},
               {"stroke", "#ffffff"},
               {"stroke-width", "3"},
               {"paint-order", "stroke"}});
  }

  const RegionPicture& picture_;
  double radius_;
  Eigen::Vector3d toward_, up_, right_;
  Svg svg_;
};

SizedSvg on_sphere(const RegionPicture& picture) {
  constexpr double kRadius = 190.0;
  constexpr double kSpace = 70.0;
  constexpr double kText = 420.0;
  SizedSvg result;
  const double middle = kSpace + kRadius;
  result.svg.add(middle, middle, Sphere{picture, kRadius}.drawn());

  const double left = 2.0 * middle + 10.0;
  double y = 60.0;
  const auto line = [&](const std::string& text, SvgAttributes attributes) {
    result.svg.text(left, y, text, attributes);
    y += 19.0;
  };
  line("Reward weights of length 1, seen from the robot's", {{"font-weight", "bold"}});
  y += 6.0;

  const auto sample = [&](const char* color, const std::string& text) {
    result.svg.add(
        "rect",
        {{"x", svg_number(left)}, {"y", svg_number(y - 11)}, {"width", "14"}, {"height", "14"}, {"fill", color}});
    result.svg.text(left + 22, y, text);
    y += 21.0;
  };

  sample(kPale, fmt::format("known beforehand: {:.4f} sr", picture.prior.solid_angle()));
  sample(kDark, fmt::format("all that make the robot's policy: {:.4f} sr", picture.region.solid_angle()));
  sample(kRobot, "the robot's own");
  y += 8.0;

  for (std::size_t i = 0; i < picture.captions.size(); ++i) {
    constexpr std::size_t kCharacters = 56;
    std::string rest = wrapped(fmt::format("{}  {}", i + 1, picture.captions[i]), kCharacters, "    ");
    while (!rest.empty()) {
      const auto end = rest.find('\n');
      const auto text = rest.substr(0, end);
      const bool goes_on = text.substr(0, 4) == "    ";
      result.svg.text(left + (goes_on ? 14 : 0), y, goes_on ? text.substr(4) : text);
      y += 18.0;
      rest = end == std::string::npos ? "" : rest.substr(end + 1);
    }
    y += 3.0;
  }
  result.width = left + kText;
  result.height = std::max(2.0 * middle, y + 20.0);
  return result;
}

// One pair of features: what the sphere looks like to these two weights.
void panel(Svg& svg, const RegionPicture& picture, std::size_t across, std::size_t up, double radius) {
  constexpr std::size_t kPoints = 500;
  svg.add("circle", {{"cx", "0"}, {"cy", "0"}, {"r", svg_number(radius)}, {"fill", "#fafbfc"}, {"stroke", "#d5d9de"}});
  svg.line(-radius, 0, radius, 0, {{"stroke", "#d5d9de"}});
  svg.line(0, -radius, 0, radius, {{"stroke", "#d5d9de"}});
  const auto end = [&](double x, double y, const char* sign) {
    constexpr double kInside = 9.0;
    svg.text(x * (radius - kInside), y * (radius - kInside) + 4, sign,
             {{"text-anchor", "middle"}, {"font-size", "12"}, {"fill", kMuted}});
  };
  end(1, 0, "+");
  end(-1, 0, "\u2212");
  end(0, -1, "+");
  end(0, 1, "\u2212");
  const auto dots = [&](const Cone& cone, const std::string& color, double radius_of_dots) {
    const auto points = ConeSampler{cone}.cover(kPoints);
    std::string path;
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
      path += fmt::format("M{} {}h0", svg_number(radius_of_dots * points(static_cast<Eigen::Index>(across), i)),
                          svg_number(-radius_of_dots * points(static_cast<Eigen::Index>(up), i)));
    }
    svg.add("path", {{"d", path},
                     {"stroke", color},
                     {"stroke-width", "3"},
                     {"stroke-linecap", "round"},
                     {"stroke-opacity", "0.7"}});
  };
  // With two features both are parts of the circle, and the robot's own would lie on a small one: it is drawn outside.
  constexpr double kOutside = 1.09;
  dots(picture.prior, "#b9cbdd", radius);
  dots(picture.region, kDark, picture.features.size() == 2 ? kOutside * radius : radius);
  double length = 0.0;
  for (const auto entry : picture.robot) length += static_cast<double>(entry) * static_cast<double>(entry);
  const double scale = radius / std::sqrt(length);
  svg.add("circle", {{"cx", svg_number(scale * static_cast<double>(picture.robot[across]))},
                     {"cy", svg_number(-scale * static_cast<double>(picture.robot[up]))},
                     {"r", "4.5"},
                     {"fill", kRobot},
                     {"stroke", "#ffffff"}});
}

SizedSvg in_pairs(const RegionPicture& picture) {
  constexpr double kRadius = 80.0;
  constexpr double kStep = 190.0;
  constexpr double kLeft = 120.0;
  constexpr double kTop = 80.0;
  const auto d = picture.features.size();
  SizedSvg result;
  result.svg.text(16, 28, "Reward weights of length 1, two features at a time", {{"font-weight", "bold"}});
  result.svg.text(16, 48, "pale: known beforehand; blue: all that make the robot's policy; orange: the robot's own",
                  {{"fill", kMuted}});
  for (std::size_t row = 1; row < d; ++row) {
    const double y = kTop + kStep * (static_cast<double>(row) - 0.5);
    result.svg.text(kLeft - 14, y + 4, picture.features[row], {{"text-anchor", "end"}});
    for (std::size_t column = 0; column < row; ++column) {
      Svg one;
      panel(one, picture, column, row, kRadius);
      result.svg.add(kLeft + kStep * (static_cast<double>(column) + 0.5), y, one);
    }
  }
  for (std::size_t column = 0; column + 1 < d; ++column) {
    result.svg.text(kLeft + kStep * (static_cast<double>(column) + 0.5), kTop + kStep * static_cast<double>(d - 1) + 14,
                    picture.features[column], {{"text-anchor", "middle"}});
  }
  result.width = std::max(620.0, kLeft + kStep * static_cast<double>(d - 1) + 20.0);
  result.height = kTop + kStep * static_cast<double>(d - 1) + 40.0;
  return result;
}

}  // namespace

SizedSvg region_svg(const RegionPicture& picture) {
  return picture.features.size() == 3 ? on_sphere(picture) : in_pairs(picture);
}

}  // namespace kith
