#include "kith/explain/svg.hpp"

#include <fmt/format.h>

namespace kith {
namespace {

std::string attributes_text(SvgAttributes attributes) {
  std::string text;
  for (const auto& [name, value] : attributes) text += fmt::format(" {}=\"{}\"", name, svg_escaped(value));
  return text;
}

}  // namespace

std::string svg_number(double value) {
  auto text = fmt::format("{:.2f}", value);
  while (text.back() == '0') text.pop_back();
  if (text.back() == '.') text.pop_back();
  return text == "-0" ? "0" : text;
}

std::string svg_escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c == '<') {
      result += "&lt;";
    } else if (c == '>') {
      result += "&gt;";
    } else if (c == '&') {
      result += "&amp;";
    } else if (c == '"') {
      result += "&quot;";
    } else {
      result += c;
    }
  }
  return result;
}

void Svg::add(std::string_view name, SvgAttributes attributes, std::string_view content) {
  body_ += fmt::format("<{}{}", name, attributes_text(attributes));
  body_ += content.empty() ? "/>\n" : fmt::format(">{}</{}>\n", content, name);
}

void Svg::text(double x, double y, std::string_view words, SvgAttributes attributes) {
  body_ += fmt::format("<text x=\"{}\" y=\"{}\"{}>{}</text>\n", svg_number(x), svg_number(y),
                       attributes_text(attributes), svg_escaped(words));
}

void Svg::line(double x1, double y1, double x2, double y2, SvgAttributes attributes) {
  body_ += fmt::format("<line x1=\"{}\" y1=\"{}\" x2=\"{}\" y2=\"{}\"{}/>\n", svg_number(x1), svg_number(y1),
                       svg_number(x2), svg_number(y2), attributes_text(attributes));
}

void Svg::add(double x, double y, const Svg& other, double scale) {
  body_ += fmt::format("<g transform=\"translate({} {}){}\">\n{}</g>\n", svg_number(x), svg_number(y),
                       scale == 1.0 ? "" : " scale(" + svg_number(scale) + ")", other.body_);
}

std::string Svg::file(double width, double height, std::string_view title) const {
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" role=\"img\" "
      "font-family=\"Helvetica Neue, Helvetica, Arial, Liberation Sans, sans-serif\" font-size=\"13\" "
      "fill=\"#1c2127\">\n<title>{2}</title>\n<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n{3}</svg>\n",
      svg_number(width), svg_number(height), svg_escaped(title), body_);
}

double svg_text_width(std::string_view text, double size) {
  constexpr double kMeanWidth = 0.53;  // of a character of a sans-serif type, in its size
  return kMeanWidth * size * static_cast<double>(text.size());
}

}  // namespace kith
