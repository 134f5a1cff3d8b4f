#include "kith/learners/discussion.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>

namespace kith {
namespace detail {

// The registry: one row per model. Each is defined in a file of its own.
DiscussionModel no_discussion();
DiscussionModel degroot_discussion();
DiscussionModel majority_discussion();
DiscussionModel truth_wins_discussion();

}  // namespace detail

std::span<const DiscussionModel> discussion_models() {
  static const std::array kModels{detail::no_discussion(), detail::degroot_discussion(), detail::majority_discussion(),
                                  detail::truth_wins_discussion()};
  return kModels;
}

bool can_discuss(const Session& session) {
  std::size_t answered = 0;
  for (std::size_t i = 0; i < session.num_members(); ++i) answered += session.has_answered(i) ? 1u : 0u;
  return answered >= 2;
}

std::vector<std::vector<Answer>> discuss(const DiscussionChoice& choice, const Session& session, TeachingCache& cache,
                                         std::span<Learner* const> learners, std::span<const RandomStream> persons) {
  if (learners.size() != session.num_members() || persons.size() != session.num_members()) {
    throw std::invalid_argument{"discuss: there must be one learner and one stream per seat"};
  }
  std::vector<std::vector<Answer>> revised(learners.size());
  if (!choice.is_held()) return revised;
  std::vector<std::size_t> seats;
  for (std::size_t i = 0; i < learners.size(); ++i) {
    if (session.has_answered(i)) seats.push_back(i);
  }
  std::sort(seats.begin(), seats.end(),
            [&](std::size_t a, std::size_t b) { return persons[a].address() < persons[b].address(); });
  const auto& lesson = session.lesson();
  Discussion discussion{cache.behaviours(), lesson.tests, lesson.period, {}};
  for (const auto seat : seats) {
    discussion.members.push_back(
        {learners[seat], session.answers(seat), persons[seat].split("discussion").split(lesson.period)});
  }
  auto after = choice.model->revise(choice.values, discussion);
  for (std::size_t i = 0; i < seats.size(); ++i) {
    if (after[i] != discussion.members[i].answers) revised[seats[i]] = std::move(after[i]);
  }
  return revised;
}

}  // namespace kith
