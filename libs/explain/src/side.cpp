#include "side.hpp"

#include <cctype>

namespace kith::detail {
namespace {

bool is_gerund(const std::string& word) {
  const auto letters = word.substr(0, word.find(','));
  return letters.size() > 4 && letters.ends_with("ing");
}

}  // namespace

Thing thing(const Wording& wording, std::int64_t n) {
  Thing result{times(wording, n), times_fewer(wording, n), n};
  const auto first = wording.one.substr(0, wording.one.find(' '));
  if (!result.words.empty() && std::isdigit(static_cast<unsigned char>(result.words.front())) != 0) {
    result.number = Number::kPlural;
  } else if (is_gerund(first) || first == "a" || first == "an" || first == "one" || first == "the") {
    result.number = Number::kSingular;
  }
  return result;
}

}  // namespace kith::detail
