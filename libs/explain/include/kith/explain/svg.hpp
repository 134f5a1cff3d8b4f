#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>

namespace kith {

/// Attributes of an element: name and value.
using SvgAttributes = std::initializer_list<std::pair<std::string_view, std::string>>;

/// A number with at most two digits behind the point.
[[nodiscard]] std::string svg_number(double value);

/// Text with <, > and & written so that it stays text.
[[nodiscard]] std::string svg_escaped(std::string_view text);

/// A drawing that grows element by element, in user units of one pixel. Light ground, dark ink, no network.
class Svg {
 public:
  /// Adds an element; `content` is markup.
  void add(std::string_view name, SvgAttributes attributes, std::string_view content = "");
  /// Adds a line of text; attributes besides the place as in SVG.
  void text(double x, double y, std::string_view words, SvgAttributes attributes = {});
  void line(double x1, double y1, double x2, double y2, SvgAttributes attributes);
  /// Adds another drawing with its origin at (x, y), larger or smaller.
  void add(double x, double y, const Svg& other, double scale = 1.0);

  /// The whole file.
  /// @param title  what it shows, for people who do not see it and for tooltips.
  [[nodiscard]] std::string file(double width, double height, std::string_view title) const;

 private:
  std::string body_;
};

/// How wide a text is about, in pixels.
[[nodiscard]] double svg_text_width(std::string_view text, double size);

}  // namespace kith
