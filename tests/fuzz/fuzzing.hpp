#pragma once

// What the fuzz targets share. A target is a function of any bytes, run(), and says what its inputs look like, kForm;
// it is driven by libFuzzer (libfuzzer.cpp), or by replay.cpp over the files of its corpus.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "kith/core/diagnostic.hpp"
#include "mutate/mutate.hpp"

namespace kith::fuzzing {

/// How far an input came.
enum class Outcome {
  kMalformed,  ///< It is no TOML, JSON, CSV with these columns, ...: its meaning was never looked at.
  kRefused,
  kRead
};

/// What the inputs of a target look like.
struct Form {
  const char* words = nullptr;    ///< A dictionary, where they are text; else they are bytes.
  std::size_t head_bytes = 0;     ///< So many in front say what the rest is about.
  std::size_t head_lines = 0;     ///< The same of text.
  std::size_t width = 0;          ///< Of rows of bytes, if there are rows.
  std::size_t bytes_one_in = 20;  ///< How often text is changed as bytes.
};
/// A width: the dimensions that the first byte stands for, Bytes::dimension().
inline constexpr auto kByFirstByte = static_cast<std::size_t>(-1);

/// Every target defines these two.
extern const Form kForm;
[[nodiscard]] Outcome run(std::string_view input);

/// The input with a change that leaves it well-formed, mostly.
[[nodiscard]] std::string mutated(std::string_view input, Dice& dice);
/// The input with a part of another.
[[nodiscard]] std::string crossed(std::string_view input, std::string_view other, Dice& dice);

/// An input's first lines or bytes, which say what the rest is about, and the rest.
struct HeadAndBody {
  std::string_view head;
  std::string_view body;
};
[[nodiscard]] HeadAndBody behind_bytes(std::string_view input, std::size_t bytes);
[[nodiscard]] HeadAndBody behind_lines(std::string_view input, std::size_t lines);

/// Ends the program if the claim does not hold.
void require(bool holds, std::string_view claim, std::string_view detail = {});

/// Diagnostics are fit to be shown: an id, a sentence, the file, a place in its text, the
/// line that stands there. `text` is what was read under the name `file`; diagnostics of other files have no place that
/// could be checked. @return how far the text came that they are about.
Outcome require_good(const std::vector<Diagnostic>& diagnostics, std::string_view text, const std::string& file);

/// Runs `read`; a kith::Error must carry good diagnostics or at least say something.
Outcome reads(std::string_view text, const std::string& file, const std::function<void()>& read);

/// Numbers made from the bytes of an input; zeros once they are used up.
class Bytes {
 public:
  explicit Bytes(std::string_view bytes) : left_{bytes} {}
  [[nodiscard]] bool empty() const noexcept { return left_.empty(); }
  [[nodiscard]] std::uint8_t byte();
  /// In [0, n).
  [[nodiscard]] std::size_t below(std::size_t n) { return byte() % n; }
  /// 2 to 8.
  [[nodiscard]] std::size_t dimension() { return 2 + below(7); }
  /// In [-limit, limit], of two bytes.
  [[nodiscard]] std::int64_t integer(std::int64_t limit);
  /// In [0, 1], of one byte.
  [[nodiscard]] double fraction() { return byte() / 255.0; }
  /// Up to the next line break, which is passed over.
  [[nodiscard]] std::string_view line();
  [[nodiscard]] std::string_view rest() const noexcept { return left_; }

 private:
  std::string_view left_;
};

/// A file that is nowhere on a disk, for what reads files only.
class MemoryFile {
 public:
  explicit MemoryFile(std::string_view content);
  ~MemoryFile();
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  [[nodiscard]] std::filesystem::path path() const;

 private:
  int descriptor_;
};

}  // namespace kith::fuzzing
