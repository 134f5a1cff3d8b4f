#include <algorithm>
#include <optional>

#include "kith/learners/discussion.hpp"

namespace kith {
namespace {

std::span<const Parameter> degroot_parameters() {
  static const std::vector<Parameter> kParameters{
      {.name = "openness",
       .default_value = 0.5,
       .description = "share a of the group's mean belief in what a member believes after the discussion"},
  };
  return kParameters;
}

// How much everybody trusts each of them: precision of the belief, 1 / spread^2, summing to 1.
std::vector<double> trust_in(const std::vector<std::optional<ParticleBelief>>& beliefs) {
  constexpr double kLeastSpread = 1e-6;
  std::vector<double> trust;
  double sum = 0.0;
  for (const auto& belief : beliefs) {
    const double spread = belief ? std::max(belief->spread(), kLeastSpread) : 0.0;
    trust.push_back(belief ? 1.0 / (spread * spread) : 0.0);
    sum += trust.back();
  }
  for (double& one : trust) one = sum > 0.0 ? one / sum : 0.0;
  return trust;
}

std::vector<std::vector<Answer>> share_beliefs(const ParameterValues& values, Discussion& discussion) {
  const double openness = values.real("openness");
  auto& members = discussion.members;
  std::vector<std::optional<ParticleBelief>> beliefs;
  for (const auto& member : members) {
    const auto* belief = member.learner != nullptr ? member.learner->belief() : nullptr;
    beliefs.push_back(belief != nullptr ? std::optional{*belief} : std::nullopt);
  }
  const auto trust = trust_in(beliefs);
  std::vector<StartIndex> tests;
  for (const auto& test : discussion.tests) tests.push_back(test.start);
  std::vector<std::vector<Answer>> revised(members.size());
  for (std::size_t i = 0; i < members.size(); ++i) {
    if (!beliefs[i]) continue;
    auto mixed = *beliefs[i];
    double mass = 1.0 - openness + openness * trust[i];  // of what is in the mixture so far
    for (std::size_t j = 0; j < members.size(); ++j) {
      if (j == i || !beliefs[j] || beliefs[j]->size() != mixed.size()) continue;
      const double more = openness * trust[j];
      if (more <= 0.0) continue;
      mass += more;
      mixed.blend(*beliefs[j], std::min(more / mass, 1.0), members[i].random.split(j));
    }
    members[i].learner->believe(std::move(mixed));
    revised[i] = members[i].learner->answer(discussion.behaviours, tests, discussion.period).answers;
  }
  return revised;
}

}  // namespace

namespace detail {

DiscussionModel degroot_discussion() {
  return {"degroot",
          "members move towards the group's mean belief, in which those who are surer count more, and answer by that",
          degroot_parameters(), share_beliefs};
}

}  // namespace detail

}  // namespace kith
