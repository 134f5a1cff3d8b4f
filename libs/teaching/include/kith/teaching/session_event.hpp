#pragma once

#include <cstddef>
#include <string_view>
#include <variant>
#include <vector>

#include "kith/teaching/lesson.hpp"
#include "kith/teaching/shared_list.hpp"
#include "kith/teaching/strategy.hpp"

namespace kith {

/// The teacher chose the next lesson, or found that there is none.
struct LessonProposed {
  friend bool operator==(const LessonProposed&, const LessonProposed&) = default;
};
/// Everybody present watched the demonstrations.
struct LessonShown {
  friend bool operator==(const LessonShown&, const LessonShown&) = default;
};
/// A member answered the tests, one answer per test in order.
struct TestsAnswered {
  std::size_t member = 0;  ///< Seat.
  std::vector<Answer> answers;
  friend bool operator==(const TestsAnswered&, const TestsAnswered&) = default;
};
/// No more answers are taken; who has not answered has no answers.
struct TestsClosed {
  friend bool operator==(const TestsClosed&, const TestsClosed&) = default;
};
/// Everybody present heard the feedback. The period ends.
struct FeedbackGiven {
  friend bool operator==(const FeedbackGiven&, const FeedbackGiven&) = default;
};
/// A member leaves.
struct MemberLeft {
  std::size_t member = 0;
  friend bool operator==(const MemberLeft&, const MemberLeft&) = default;
};
/// A member who left is back and takes part from the next lesson on.
struct MemberReturned {
  std::size_t member = 0;
  friend bool operator==(const MemberReturned&, const MemberReturned&) = default;
};

/// Lessons are chosen by another strategy from now on.
struct StrategyChanged {
  StrategyChoice strategy;
  friend bool operator==(const StrategyChanged&, const StrategyChanged&) = default;
};

/// Somebody else takes the place of a member who left, and takes part from the next lesson on.
struct MemberReplaced {
  std::size_t member = 0;
  friend bool operator==(const MemberReplaced&, const MemberReplaced&) = default;
};

/// After all had answered, members saw each other's answers without names and could revise their own.
struct AnswersDiscussed {
  std::vector<std::vector<Answer>> revised;  ///< Per member, one answer per test; empty: kept all.
  friend bool operator==(const AnswersDiscussed&, const AnswersDiscussed&) = default;
};

/// Everything that can happen to a session, see Session. The order stays: keys of lessons count in it.
using SessionEvent = std::variant<LessonProposed, LessonShown, TestsAnswered, TestsClosed, FeedbackGiven, MemberLeft,
                                  MemberReturned, StrategyChanged, MemberReplaced, AnswersDiscussed>;
/// In the order in which they happened.
using SessionEvents = SharedList<SessionEvent>;

/// "lesson-proposed", "lesson-shown", "tests-answered", "tests-closed", "feedback-given", "member-left",
/// "member-returned", "strategy-changed", "member-replaced", "answers-discussed".
[[nodiscard]] std::string_view name_of(const SessionEvent& event) noexcept;

}  // namespace kith
