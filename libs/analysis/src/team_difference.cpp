#include "kith/analysis/team_difference.hpp"

#include "kith/analysis/moments.hpp"

namespace kith {

std::vector<double> means_of_people(const TeamValues& values) {
  std::vector<double> means;
  for (const auto& [people, of_teams] : values) means.push_back(mean(of_teams));
  return means;
}

TeamDifference difference_of_teams(const TeamValues& first, const TeamValues& second, bool same_people,
                                   double confidence) {
  auto a = first, b = second;
  if (same_people) {
    std::erase_if(a, [&](const auto& one) { return !second.contains(one.first); });
    std::erase_if(b, [&](const auto& one) { return !first.contains(one.first); });
  }
  const auto values = means_of_people(a), others = means_of_people(b);
  const auto test = same_people ? paired_t_test(values, others, confidence) : welch_t_test(values, others, confidence);
  if (values.empty() || others.empty()) return {.n = values.size(), .test = test};
  return {values.size(), mean(values) - mean(others), test};
}

}  // namespace kith
