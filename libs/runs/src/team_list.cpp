#include "team_list.hpp"

namespace kith {

std::string team_list(std::span<const std::size_t> teams) {
  constexpr std::size_t kMostRanges = 20;
  std::string text = teams.size() == 1 ? "team " : "teams ";
  std::size_t ranges = 0;
  for (std::size_t i = 0; i < teams.size(); ++ranges) {
    if (ranges == kMostRanges) return text + " and " + std::to_string(teams.size() - i) + " more";
    std::size_t last = i;
    while (last + 1 < teams.size() && teams[last + 1] == teams[last] + 1) ++last;
    text += (ranges > 0 ? ", " : "") + std::to_string(teams[i]);
    if (last > i) text += "-" + std::to_string(teams[last]);
    i = last + 1;
  }
  return text;
}

}  // namespace kith
