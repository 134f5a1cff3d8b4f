#include <algorithm>

#include "kith/core/distributions.hpp"
#include "kith/domains/judgement.hpp"
#include "kith/learners/discussion.hpp"

namespace kith {
namespace {

std::span<const Parameter> truth_wins_parameters() {
  static const std::vector<Parameter> kParameters{
      {.name = "convinces",
       .default_value = 0.7,
       .description = "probability that a member who is wrong is convinced by one who is right, for every test"},
  };
  return kParameters;
}

bool is_right(const Discussion& discussion, std::size_t test, const Answer& answer) {
  if (!answer) return false;
  const auto& atlas = discussion.behaviours.atlas();
  return judge_path(atlas.domain(), atlas.feature_counts(discussion.tests[test].start), *answer).is_right;
}

// The right answer that members gave to a test; of several the smallest.
Answer right_answer(const Discussion& discussion, std::size_t test) {
  Answer best;
  for (const auto& member : discussion.members) {
    const auto& answer = member.answers[test];
    if (!is_right(discussion, test, answer)) continue;
    if (!best || std::lexicographical_compare(answer->begin(), answer->end(), best->begin(), best->end()))
      best = answer;
  }
  return best;
}

std::vector<std::vector<Answer>> follow_truth(const ParameterValues& values, Discussion& discussion) {
  std::vector<std::vector<Answer>> revised(discussion.members.size());
  for (std::size_t i = 0; i < revised.size(); ++i) {
    auto& member = discussion.members[i];
    if (member.learner == nullptr) continue;
    revised[i] = member.answers;
    std::vector<HalfSpace> convinced_of;
    for (std::size_t t = 0; t < discussion.tests.size(); ++t) {
      const auto right = right_answer(discussion, t);
      auto random = member.random.split(t);
      const bool is_convinced = uniform01(random) < values.real("convinces");
      if (!right || !is_convinced || is_right(discussion, t, member.answers[t])) continue;
      revised[i][t] = right;
      for (const auto& half_space : discussion.tests[t].covered) {
        if (std::find(convinced_of.begin(), convinced_of.end(), half_space) == convinced_of.end())
          convinced_of.push_back(half_space);
      }
    }
    if (!convinced_of.empty()) member.learner->be_convinced(convinced_of, discussion.period);
  }
  return revised;
}

}  // namespace

namespace detail {

DiscussionModel truth_wins_discussion() {
  return {"truth-wins", "members who are wrong may be convinced by one who is right, and learn what the answer shows",
          truth_wins_parameters(), follow_truth};
}

}  // namespace detail

}  // namespace kith
