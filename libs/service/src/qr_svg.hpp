#pragma once

#include <optional>
#include <string>

namespace kith {

// A QR code as an SVG picture of black squares on white, with the quiet zone of four modules that scanners need.
// Nothing if the text is too long for a QR code.
[[nodiscard]] std::optional<std::string> qr_svg(const std::string& text);

}  // namespace kith
