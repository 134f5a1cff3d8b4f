#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace kith::detail {

// An entry of a BibTeX file.
struct Reference {
  std::string key;
  std::string type;                           // "article"
  std::map<std::string, std::string> fields;  // without braces, on one line
  std::string bibtex;                         // the entry as it stands in the file
};

// The entries of a BibTeX text that keeps to `@type{key, name = {value}, ...}`.
[[nodiscard]] std::vector<Reference> parse_bibtex(std::string_view text);

// "Jayaraman, S. K., Simmons, R., Steinfeld, A., & Admoni, H. (2024). Title. Journal, 3(2), 1-4."
[[nodiscard]] std::string reference_text(const Reference& reference);
// "Jayaraman et al., 2024"
[[nodiscard]] std::string citation_text(const Reference& reference);

}  // namespace kith::detail
