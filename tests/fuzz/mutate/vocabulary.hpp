#pragma once

#include <string>
#include <vector>

namespace kith::fuzzing {

/// The words of a target's dictionary, tests/fuzz/dictionaries/<name>.dict.
class Vocabulary {
 public:
  /// No words.
  Vocabulary() = default;
  /// @throws kith::Error if there is no such dictionary.
  explicit Vocabulary(const std::string& name);

  /// Anything, punctuation too.
  [[nodiscard]] const std::vector<std::string>& words() const noexcept { return words_; }
  /// Those that a key or a column can be called.
  [[nodiscard]] const std::vector<std::string>& names() const noexcept { return names_; }

 private:
  std::vector<std::string> words_;
  std::vector<std::string> names_;
};

}  // namespace kith::fuzzing
