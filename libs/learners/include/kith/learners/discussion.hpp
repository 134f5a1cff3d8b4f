#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "kith/bec/behaviours.hpp"
#include "kith/core/parameter.hpp"
#include "kith/core/stream.hpp"
#include "kith/learners/learner.hpp"
#include "kith/teaching/session.hpp"

namespace kith {

/// A member who has answered the tests of a period and now sees the answers of the others, without names.
struct Discussant {
  Learner* learner = nullptr;   ///< Null: not simulated. Their answers are seen, but nothing is revised for them.
  std::vector<Answer> answers;  ///< Their first ones, one per test.
  RandomStream random{0};       ///< Of what they do in this discussion.
};

/// A group that talks about the tests of a period.
struct Discussion {
  Behaviours& behaviours;  ///< Of the calling thread; changes no result.
  std::span<const Test> tests;
  std::size_t period = 1;
  std::vector<Discussant> members;  ///< In an order that does not depend on seats.
};

/// A way in which groups talk: a row of the registry. To add one, see docs/library.md.
struct DiscussionModel {
  std::string_view name;                  ///< `group.discussion.model` in study files.
  std::string_view description;           ///< One sentence without a full stop.
  std::span<const Parameter> parameters;  ///< Keys of `[group.discussion]` besides `model`.
  /// What the members answer afterwards, in their order; empty for those who keep all answers. May change what the
  /// learners believe. Null: this group does not talk.
  std::vector<std::vector<Answer>> (*revise)(const ParameterValues& values, Discussion& discussion) = nullptr;
};

/// The built-in models. The first one, "none", is what a study without `[group.discussion]` has.
[[nodiscard]] std::span<const DiscussionModel> discussion_models();

/// A model with its parameters.
struct DiscussionChoice {
  const DiscussionModel* model = &discussion_models().front();
  ParameterValues values{model->parameters};
  /// Whether members talk at all.
  [[nodiscard]] bool is_held() const noexcept { return model->revise != nullptr; }
  friend bool operator==(const DiscussionChoice& a, const DiscussionChoice& b) {
    return a.model->name == b.model->name && a.values == b.values;
  }
};

/// Whether a group that talks has anything to talk about: at least two members have answered the current tests.
[[nodiscard]] bool can_discuss(const Session& session);

/// What simulated members answer after a discussion, as Session::discuss() takes it; empty for all others. Seats do not
/// matter: members are told apart by their streams only.
/// @pre can_discuss(session), one learner (null: not simulated) and one stream per seat.
/// @param cache  of the session's atlas; changes no result.
/// @param persons  the root of what each person draws when the group talks.
[[nodiscard]] std::vector<std::vector<Answer>> discuss(const DiscussionChoice& choice, const Session& session,
                                                       TeachingCache& cache, std::span<Learner* const> learners,
                                                       std::span<const RandomStream> persons);

}  // namespace kith
