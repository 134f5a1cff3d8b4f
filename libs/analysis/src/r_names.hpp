#pragma once

#include <map>
#include <string>
#include <vector>

namespace kith {

// Names of columns as R takes them everywhere without quotes: a letter, then letters, digits, '.' and '_'; no reserved
// word. Functions such as car::Anova() fail for others where cells are empty.
class RNames {
 public:
  explicit RNames(const std::vector<std::string>& columns);

  // Of a column that the constructor got.
  [[nodiscard]] const std::string& operator[](const std::string& column) const { return names_.at(column); }
  // Columns whose name in R differs, in the order of the constructor.
  [[nodiscard]] const std::vector<std::string>& renamed() const noexcept { return renamed_; }

 private:
  std::map<std::string, std::string> names_;
  std::vector<std::string> renamed_;
};

}  // namespace kith
