// Who the members may be, when a component has been taught enough, and who is done with it.

#include <algorithm>

#include "kith/teaching/known_components.hpp"
#include "kith/teaching/session.hpp"

namespace kith {

// The rules, and what they read.
void Session::make_rules(TeachingCache& cache) {
  StopNeeds needs;
  const auto made = [&](const StopChoice& rule) {
    const auto more = rule.kind.needs != nullptr ? rule.kind.needs(*atlas_) : StopNeeds{};
    needs = {.bank = needs.bank || more.bank, .beliefs = needs.beliefs || more.beliefs};
    return rule.kind.make(rule.parameters, cache);
  };
  mastery_ = made(options_.mastery);
  if (options_.release) release_ = made(*options_.release);

  if (needs.beliefs) {
    auto options = belief_.options();
    options.response_noise = 0.0;
    options.members = true;
    options.rules.clear();
    judged_.emplace(cache.start_of(options_), options, persons_, teacher_.split("judged belief"));
  }

  if (options_.hypotheses_about == HypothesesAbout::kKnownComponents)
    options_.hypotheses = grid_of_known_components(atlas_->knowledge_components().size());
  if (options_.hypotheses_about == HypothesesAbout::kNothing) options_.hypotheses = one_hypothesis();
  const bool asks_for_kinds = options_.hypotheses_about == HypothesesAbout::kKinds;
  if (asks_for_kinds) options_.hypotheses = options_.kinds;
  if (!asks_for_kinds && !needs.bank && !options_.keep_bank && !choice_.kind.needs(choice_.parameters).bank) return;
  bank_.emplace(cache.start_of(options_), options_.filter, options_.likelihood, options_.hypotheses, persons_,
                options_.shares_bank ? std::optional{teacher_.split("bank")} : std::nullopt, options_.response_noise,
                constraints_of_components(*atlas_));
}

bool Session::awaits_newcomer() const {
  for (std::size_t i = 0; i < num_members(); ++i) {
    if (is_new_[i] && attendance_[i] == Attendance::kReturning) return true;
  }
  return false;
}

// Nothing is known about them, whatever was known about those who had their places.
void Session::admit_newcomers(TeachingCache& cache) {
  const auto& cover = cache.start_of(options_);
  for (std::size_t i = 0; i < num_members(); ++i) {
    if (!is_new_[i] || attendance_[i] != Attendance::kReturning) continue;
    belief_.restart(i, cover);
    if (judged_) judged_->restart(i, cover);
    if (bank_) {
      bank_->restart(i, cover, options_.filter, options_.hypotheses, persons_[i], constraints_of_components(*atlas_));
    }
    right_in_a_row_[i] = 0;
    is_new_[i] = false;
  }
}

// Whether the component is left after this period, and who is done with it before the others.
// @param rows  per member, periods in a row with all answers right, with this one.
void Session::decide(Feedback& feedback, const std::vector<bool>& counted, std::span<const std::size_t> rows) {
  auto expected = judged_;
  if (expected) {
    if (expected->present() != counted) expected->set_present(counted);
    expected->observe_feedback(feedback.half_spaces, lesson_.period);
  }
  const auto seen = view(belief_, lesson_.component);
  const ClosedTests closed{.view = seen,
                           .lesson = lesson_,
                           .feedback = feedback,
                           .counted = counted,
                           .rows = rows,
                           .bank = bank_ ? &*bank_ : nullptr,
                           .expected = expected ? &*expected : nullptr};

  std::vector<std::size_t> done;
  for (std::size_t i = 0; release_ && i < num_members(); ++i) {
    if (counted[i] && release_->is_done(closed, i)) done.push_back(i);
  }
  const auto verdict = mastery_->judge_team(closed);
  const auto num_counted = static_cast<std::size_t>(std::count(counted.begin(), counted.end(), true));
  level_ = verdict.level;
  feedback.component_learned = verdict.is_enough || done.size() == num_counted;
  if (!feedback.component_learned) feedback.released = std::move(done);
}

// The answers of everybody who gave any, and the feedback that follows.
void Session::inform_bank(const Feedback& feedback, const std::vector<bool>& present) {
  if (!bank_) return;
  std::vector<std::vector<Answer>> answers(num_members());
  for (std::size_t i = 0; i < num_members(); ++i) {
    if (has_answered(i)) answers[i] = pending_[i]->answers;
  }
  bank_->close_tests(*atlas_, lesson_, answers, feedback, present);
}

}  // namespace kith
