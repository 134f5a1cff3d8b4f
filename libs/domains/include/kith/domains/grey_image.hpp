#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "kith/domains/model_text.hpp"

namespace kith::detail {

// A grey image, top row first.
struct GreyImage {
  std::size_t width = 0;
  std::size_t height = 0;
  std::uint8_t white = 255;        // the largest value
  std::vector<std::uint8_t> grey;  // shape [height, width]; 0 is black

  [[nodiscard]] std::uint8_t at(std::size_t x, std::size_t y) const { return grey[y * width + x]; }
};

// The most pixels that an image may have: as text they fit in a file of 64 MiB.
inline constexpr std::size_t kMaxPixels = 16'000'000;

// Reads a portable graymap of 8 bits: P2 (text) or P5 (binary), as in netpbm's pgm(5). Nothing after reporting what is
// wrong (E0266, E0267).
[[nodiscard]] std::optional<GreyImage> read_pgm(const ModelText& file, ModelReport& report);

// The image as a portable graymap in text (P2), a line per row.
[[nodiscard]] std::string plain_pgm(const GreyImage& image);

}  // namespace kith::detail
