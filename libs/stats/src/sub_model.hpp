#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace kith::detail {

// The models that a test of type II compares: all terms that do not contain `term`, with it and without it.
struct TypeTwoModels {
  std::vector<std::vector<std::size_t>> with;
  std::vector<std::vector<std::size_t>> without;
};
[[nodiscard]] inline TypeTwoModels type_two_models(const std::vector<std::vector<std::size_t>>& terms,
                                                   std::size_t term) {
  TypeTwoModels models;
  for (std::size_t t = 0; t < terms.size(); ++t) {
    const bool contains = std::includes(terms[t].begin(), terms[t].end(), terms[term].begin(), terms[term].end());
    if (!contains) models.without.push_back(terms[t]);
    if (!contains || t == term) models.with.push_back(terms[t]);
  }
  return models;
}

}  // namespace kith::detail
