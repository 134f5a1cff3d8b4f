#include "kith/analysis/factor.hpp"

#include <limits>
#include <stdexcept>
#include <unordered_map>

namespace kith {

Factor make_factor(std::string name, std::span<const std::string> values) {
  Factor factor{std::move(name), {}, {}};
  std::unordered_map<std::string, std::size_t> code_of;
  factor.codes.reserve(values.size());
  for (const auto& value : values) {
    const auto [entry, is_new] = code_of.emplace(value, factor.levels.size());
    if (is_new) factor.levels.push_back(value);
    factor.codes.push_back(entry->second);
  }
  return factor;
}

std::vector<std::vector<double>> split_by(std::span<const double> values, const Factor& factor) {
  if (values.size() != factor.codes.size())
    throw std::invalid_argument{"split_by: one value per observation of the factor is needed"};
  std::vector<std::vector<double>> groups(factor.levels.size());
  for (std::size_t i = 0; i < values.size(); ++i) groups.at(factor.codes[i]).push_back(values[i]);
  return groups;
}

Factor interaction(const Factor& a, const Factor& b) {
  if (a.codes.size() != b.codes.size())
    throw std::invalid_argument{"interaction: both factors need one level per observation"};
  Factor both{a.name + ":" + b.name, {}, {}};
  for (const auto& first : a.levels) {
    for (const auto& second : b.levels) both.levels.push_back(std::string{first}.append(":").append(second));
  }
  both.codes.reserve(a.codes.size());
  for (std::size_t i = 0; i < a.codes.size(); ++i) both.codes.push_back(a.codes[i] * b.levels.size() + b.codes[i]);
  return both;
}

Factor drop_unused(const Factor& factor) {
  constexpr auto kUnused = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> new_code(factor.levels.size(), kUnused);
  for (const auto code : factor.codes) new_code.at(code) = 0;
  Factor used{factor.name, {}, {}};
  for (std::size_t level = 0; level < factor.levels.size(); ++level) {
    if (new_code[level] == kUnused) continue;
    new_code[level] = used.levels.size();
    used.levels.push_back(factor.levels[level]);
  }
  used.codes.reserve(factor.codes.size());
  for (const auto code : factor.codes) used.codes.push_back(new_code[code]);
  return used;
}

}  // namespace kith
