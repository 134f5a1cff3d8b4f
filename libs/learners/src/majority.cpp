#include <algorithm>

#include "kith/learners/discussion.hpp"

namespace kith {
namespace {

// The answer that most members gave to a test, if more gave it than any other.
Answer answer_of_majority(const Discussion& discussion, std::size_t test) {
  Answer most;
  std::size_t votes = 0;
  bool is_tied = false;
  for (const auto& member : discussion.members) {
    const auto& answer = member.answers[test];
    if (!answer || answer == most) continue;
    const auto same =
        static_cast<std::size_t>(std::count_if(discussion.members.begin(), discussion.members.end(),
                                               [&](const Discussant& other) { return other.answers[test] == answer; }));
    if (same < votes) continue;
    is_tied = same == votes;
    most = answer;
    votes = same;
  }
  return is_tied ? std::nullopt : most;
}

std::vector<std::vector<Answer>> follow_majority(const ParameterValues& /*values*/, Discussion& discussion) {
  std::vector<std::vector<Answer>> revised(discussion.members.size());
  for (std::size_t i = 0; i < revised.size(); ++i) {
    if (discussion.members[i].learner != nullptr) revised[i] = discussion.members[i].answers;
  }
  for (std::size_t t = 0; t < discussion.tests.size(); ++t) {
    const auto most = answer_of_majority(discussion, t);
    if (!most) continue;
    for (auto& answers : revised) {
      if (!answers.empty()) answers[t] = most;
    }
  }
  return revised;
}

}  // namespace

namespace detail {

DiscussionModel majority_discussion() {
  return {
      "majority",
      "members give the answer that most of them gave, and believe what they believed; after a tie they keep theirs",
      {},
      follow_majority};
}

}  // namespace detail

}  // namespace kith
