#include <algorithm>
#include <utility>
#include <variant>

#include "kith/teaching/session.hpp"
#include "session_checks.hpp"

namespace kith {

std::string_view name_of(const SessionEvent& event) noexcept {
  constexpr std::string_view kNames[] = {"lesson-proposed", "lesson-shown",     "tests-answered",  "tests-closed",
                                         "feedback-given",  "member-left",      "member-returned", "strategy-changed",
                                         "member-replaced", "answers-discussed"};
  static_assert(std::size(kNames) == std::variant_size_v<SessionEvent>);
  return kNames[event.index()];
}

void Session::leave(std::size_t member) {
  require_seat(member);
  if (finished()) throw Error{ErrorKind::kUsage, "nobody can leave: the session is finished"};
  if (attendance_[member] == Attendance::kAway) refuse("member " + std::to_string(member + 1) + " is away already");
  events_.push_back(events_.prepare(MemberLeft{member}));
  attendance_[member] = Attendance::kAway;
}

void Session::require_away(std::size_t member, std::string_view what) const {
  require_seat(member);
  if (finished()) throw Error{ErrorKind::kUsage, "nobody can " + std::string{what} + ": the session is finished"};
  if (attendance_[member] != Attendance::kAway) refuse("member " + std::to_string(member + 1) + " is not away");
}

void Session::come_back(std::size_t member) {
  require_away(member, "return");
  events_.push_back(events_.prepare(MemberReturned{member}));
  attendance_[member] = Attendance::kReturning;
}

void Session::replace(std::size_t member) {
  require_away(member, "take a place");
  events_.push_back(events_.prepare(MemberReplaced{member}));
  attendance_[member] = Attendance::kReturning;
  is_new_[member] = true;
}

void Session::change_strategy(StrategyChoice strategy) {
  require_phase(SessionPhase::kProposal, "changing the strategy");
  require(!strategy.is_baseline() || persons_.size() == 1, "the baseline teaches one person per session");
  const auto needs = strategy.kind.needs(strategy.parameters);
  const auto& kept = belief_.options();
  require(!needs.members || kept.members, "the strategy '" + strategy.name + "' needs the beliefs about members");
  for (const auto& name : needs.rules) {
    const bool is_kept =
        std::any_of(kept.rules.begin(), kept.rules.end(), [&](const auto& rule) { return rule.name == name; });
    require(is_kept, "the strategy '" + strategy.name + "' needs the belief '" + name + "'");
  }
  auto made = strategy.kind.make(strategy.parameters);
  events_.push_back(events_.prepare(StrategyChanged{strategy}));
  strategy_ = std::move(made);
  choice_ = std::move(strategy);
}

void Session::apply(const SessionEvent& event, TeachingCache& cache) {
  struct Visitor {
    Session& session;
    TeachingCache& cache;
    void operator()(const LessonProposed&) const { session.propose(cache); }
    void operator()(const LessonShown&) const { session.show(); }
    void operator()(const TestsAnswered& e) const { session.answer(e.member, e.answers); }
    void operator()(const TestsClosed&) const { session.close_tests(); }
    void operator()(const FeedbackGiven&) const { session.give_feedback(); }
    void operator()(const MemberLeft& e) const { session.leave(e.member); }
    void operator()(const MemberReturned& e) const { session.come_back(e.member); }
    void operator()(const MemberReplaced& e) const { session.replace(e.member); }
    void operator()(const StrategyChanged& e) const { session.change_strategy(e.strategy); }
    void operator()(const AnswersDiscussed& e) const { session.discuss(e.revised); }
  };
  std::visit(Visitor{*this, cache}, event);
}

bool operator==(const Session& a, const Session& b) {
  return a.status_ == b.status_ && a.phase_ == b.phase_ && a.component_ == b.component_ &&
         a.right_in_a_row_ == b.right_in_a_row_ && a.components_ == b.components_ && a.attendance_ == b.attendance_ &&
         a.is_new_ == b.is_new_ && a.visited_ == b.visited_ && a.taught_before_ == b.taught_before_ &&
         a.taught_with_unit_ == b.taught_with_unit_ && a.lesson_ == b.lesson_ && a.pending_ == b.pending_ &&
         a.revised_ == b.revised_ && a.feedback_ == b.feedback_ && a.history_ == b.history_ && a.events_ == b.events_ &&
         a.belief_ == b.belief_ && a.judged_ == b.judged_ && a.bank_ == b.bank_;
}

}  // namespace kith
