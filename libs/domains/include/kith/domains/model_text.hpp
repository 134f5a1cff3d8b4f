#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "kith/core/diagnostic.hpp"

namespace kith::detail {

// The text of a file that a domain file names.
struct ModelText {
  std::string name;   // as the domain file says it
  std::string shown;  // as messages say it
  std::string text;
};

// Whether its name is that of an image, which may be binary.
[[nodiscard]] bool is_image_file(std::string_view name);

// Where in a file something stands, in bytes. Without a file: in no file in particular.
struct ModelPlace {
  const ModelText* file = nullptr;
  std::size_t offset = 0;
  std::size_t length = 1;
};

// The place of `part`, which must be a part of the file's text.
[[nodiscard]] inline ModelPlace place_of(const ModelText& file, std::string_view part) {
  return {&file, static_cast<std::size_t>(part.data() - file.text.data()), part.size()};
}
// The place of what begins at `offset` and goes on to the next blank, comma or bracket.
[[nodiscard]] ModelPlace place_at(const ModelText& file, std::size_t offset);

// Collects what is wrong with the files of a model, each with file, line and column.
class ModelReport {
 public:
  // At most so many errors are kept; all are counted.
  static constexpr std::size_t kMaxErrors = 20;

  void error(std::string id, const ModelPlace& place, std::string message, std::string hint = {});
  // Well-formed, but nothing can be done with it.
  void infeasible(std::string id, const ModelPlace& place, std::string message, std::string hint = {});
  void warning(std::string id, const ModelPlace& place, std::string message, std::string hint = {});
  // What another reader found.
  void take(std::vector<Diagnostic> diagnostics);

  [[nodiscard]] std::size_t num_errors() const { return num_errors_; }
  [[nodiscard]] bool has_errors() const { return num_errors_ > 0; }
  // Reading on would only count.
  [[nodiscard]] bool is_full() const { return num_errors_ >= kMaxErrors; }
  [[nodiscard]] const std::vector<Diagnostic>& diagnostics() const { return diagnostics_; }

 private:
  void add(Diagnostic kind, const ModelPlace& place, std::string id, std::string message, std::string hint);

  std::vector<Diagnostic> diagnostics_;
  std::size_t num_errors_ = 0;
};

}  // namespace kith::detail
