#include "qr_svg.hpp"

#include <qrencode.h>

#include <memory>

namespace kith {

std::optional<std::string> qr_svg(const std::string& text) {
  constexpr int kQuiet = 4;
  if (text.empty() || text.find('\0') != std::string::npos) return std::nullopt;
  const std::unique_ptr<QRcode, decltype(&QRcode_free)> code{QRcode_encodeString8bit(text.c_str(), 0, QR_ECLEVEL_M),
                                                             QRcode_free};
  if (!code) return std::nullopt;
  const auto width = static_cast<std::size_t>(code->width);
  std::string path;
  for (std::size_t row = 0; row < width; ++row) {
    for (std::size_t column = 0; column < width; ++column) {
      if ((code->data[row * width + column] & 1u) == 0) continue;
      path += "M" + std::to_string(column + kQuiet) + "," + std::to_string(row + kQuiet) + "h1v1h-1z";
    }
  }
  const auto size = std::to_string(width + 2 * kQuiet);
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + size + " " + size +
         "\" shape-rendering=\"crispEdges\"><rect width=\"" + size + "\" height=\"" + size +
         "\" fill=\"#fff\"/><path d=\"" + path + "\" fill=\"#000\"/></svg>\n";
}

}  // namespace kith
