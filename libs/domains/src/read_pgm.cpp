#include <algorithm>
#include <charconv>
#include <string>
#include <string_view>

#include "kith/domains/grey_image.hpp"

namespace kith::detail {
namespace {

constexpr std::uint32_t kMostGrey = 255;

class PgmReader {
 public:
  PgmReader(const ModelText& file, ModelReport& report) : file_{file}, text_{file.text}, report_{report} {}

  std::optional<GreyImage> read() {
    const bool is_binary = text_.starts_with("P5");
    if (!is_binary && !text_.starts_with("P2")) {
      fail(0, "this is not a portable graymap: it does not begin with P2 or P5",
           "save the image as PGM with 8 bits per pixel, in grey");
      return std::nullopt;
    }
    at_ = 2;
    const auto width = number("the width");
    const auto height = width ? number("the height") : std::nullopt;
    const auto white = height ? number("the largest grey value") : std::nullopt;
    if (!white || !check_size(*width, *height) || !check_white(*white)) return std::nullopt;
    GreyImage image{*width, *height, static_cast<std::uint8_t>(*white), {}};
    image.grey.reserve(image.width * image.height);
    if (is_binary ? read_bytes(image) : read_numbers(image)) return image;
    return std::nullopt;
  }

 private:
  void fail(std::size_t offset, const std::string& message, const std::string& hint) {
    report_.error("E0266", place_at(file_, offset), message, hint);
  }

  static bool is_blank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

  // Blanks and comments, which go on to the end of the line.
  void skip_blanks() {
    while (at_ < text_.size() && (is_blank(text_[at_]) || text_[at_] == '#')) {
      if (text_[at_] == '#') {
        at_ = std::min(text_.find_first_of("\r\n", at_), text_.size());
      } else {
        ++at_;
      }
    }
  }

  std::optional<std::uint32_t> number(const std::string& what) {
    const std::size_t before = at_;
    skip_blanks();
    last_ = at_;
    std::uint32_t value = 0;
    const char* begin = text_.data() + at_;
    const auto [end, error] = std::from_chars(begin, text_.data() + text_.size(), value);
    at_ += static_cast<std::size_t>(end - begin);
    const bool ends = at_ == text_.size() || is_blank(text_[at_]) || text_[at_] == '#';
    if (error == std::errc{} && ends && last_ > before) return value;
    if (last_ == text_.size()) {
      fail(last_, "the image ends before " + what, "save it again; the file is not complete");
    } else {
      fail(last_, "expected " + what + ", a whole number", "save the image again as PGM with 8 bits per pixel");
    }
    return std::nullopt;
  }

  bool check_size(std::size_t width, std::size_t height) {
    const bool fits = width > 0 && height > 0 && width <= kMaxPixels && height <= kMaxPixels / width;
    if (fits) return true;
    report_.error("E0267", place_at(file_, 0),
                  "the image has " + std::to_string(width) + " x " + std::to_string(height) + " pixels; 1 to " +
                      std::to_string(kMaxPixels) + " are read",
                  "crop it, or scale it down");
    return false;
  }

  bool check_white(std::uint32_t white) {
    if (white >= 1 && white <= kMostGrey) return true;
    fail(last_, "the largest grey value is " + std::to_string(white) + ", not 1 to 255",
         "save the image with 8 bits per pixel");
    return false;
  }

  bool check_grey(std::uint32_t grey, const GreyImage& image, std::size_t offset) {
    if (grey <= image.white) return true;
    const std::size_t pixel = image.grey.size();
    fail(offset,
         "pixel (" + std::to_string(pixel % image.width + 1) + "," + std::to_string(pixel / image.width + 1) + ") is " +
             std::to_string(grey) + ", above the largest grey value " + std::to_string(image.white),
         "save the image again as PGM with 8 bits per pixel");
    return false;
  }

  bool read_numbers(GreyImage& image) {
    while (image.grey.size() < image.width * image.height) {
      const auto grey = number("pixel " + std::to_string(image.grey.size() + 1));
      if (!grey || !check_grey(*grey, image, last_)) return false;
      image.grey.push_back(static_cast<std::uint8_t>(*grey));
    }
    skip_blanks();
    if (at_ == text_.size()) return true;
    fail(at_, "the image goes on behind its last pixel", "save it again, one image in a file");
    return false;
  }

  // Bytes have no lines that could be shown: what is wrong with them is reported at the beginning of the file.
  bool read_bytes(GreyImage& image) {
    const std::size_t num_pixels = image.width * image.height;
    std::size_t begin = std::min(at_ + 1, text_.size());  // after a single blank
    // A header with the line ends of Windows, which other programs read as well.
    if (text_.substr(at_, 2) == "\r\n" && text_.size() - begin == num_pixels + 1) ++begin;
    const std::size_t num_bytes = text_.size() - begin;
    if (num_bytes != num_pixels && !(num_bytes == num_pixels + 1 && text_.back() == '\n')) {
      fail(0, "the image has " + std::to_string(num_bytes) + " bytes for " + std::to_string(num_pixels) + " pixels",
           num_bytes < num_pixels ? "save it again; the file is not complete" : "save it again, one image in a file");
      return false;
    }
    for (std::size_t i = 0; i < num_pixels; ++i) {
      const auto grey = static_cast<std::uint8_t>(text_[begin + i]);
      if (!check_grey(grey, image, 0)) return false;
      image.grey.push_back(grey);
    }
    return true;
  }

  const ModelText& file_;
  std::string_view text_;
  ModelReport& report_;
  std::size_t at_ = 0;
  std::size_t last_ = 0;  // where the last number begins
};

}  // namespace

std::optional<GreyImage> read_pgm(const ModelText& file, ModelReport& report) { return PgmReader{file, report}.read(); }

std::string plain_pgm(const GreyImage& image) {
  std::string text =
      "P2\n" + std::to_string(image.width) + ' ' + std::to_string(image.height) + '\n' + std::to_string(image.white);
  for (std::size_t i = 0; i < image.grey.size(); ++i) {
    text += i % image.width == 0 ? '\n' : ' ';
    text += std::to_string(image.grey[i]);
  }
  return text + '\n';
}

}  // namespace kith::detail
