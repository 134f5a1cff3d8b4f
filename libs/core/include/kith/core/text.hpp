#pragma once

#include <cstddef>
#include <functional>
#include <iterator>
#include <string>
#include <string_view>

// Words of sentences.
namespace kith {

/// The elements of a range, or what `as` makes of them, with something between; with `last` before the last one.
template <typename Range, typename As = std::identity>
[[nodiscard]] std::string joined(const Range& range, std::string_view between = ", ", As as = {},
                                 std::string_view last = {}) {
  std::string text;
  for (auto it = range.begin(); it != range.end(); ++it) {
    if (it != range.begin()) text += !last.empty() && std::next(it) == range.end() ? last : between;
    text += std::string_view{std::invoke(as, *it)};
  }
  return text;
}
/// "a", "a and b", "a, b and c"
template <typename Range, typename As = std::identity>
[[nodiscard]] std::string listed(const Range& range, As as = {}, std::string_view last = " and ") {
  return joined(range, ", ", as, last);
}
/// "1 team", "4 teams"
[[nodiscard]] inline std::string counted(std::size_t n, std::string_view noun) {
  return (std::to_string(n) + " ").append(noun).append(n == 1 ? "" : "s");
}
/// "'word'"
[[nodiscard]] inline std::string in_quotes(std::string_view text) { return std::string{"'"}.append(text).append("'"); }

}  // namespace kith
