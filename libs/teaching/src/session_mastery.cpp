// When a component has been taught enough, and who the members may be.

#include <algorithm>

#include "kith/teaching/session.hpp"

namespace kith {

void Session::make_bank(TeachingCache& cache) {
  const bool stops = options_.mastery == MasteryRule::kPosterior;
  if (stops) exam_ = cache.shared_exam();
  if (!stops && !options_.keep_bank && !choice_.kind.needs(choice_.parameters).bank) return;
  bank_.emplace(cache.cover(atlas_->prior_cone(), options_.filter.particles), options_.filter, options_.likelihood,
                options_.hypotheses, persons_);
}

// Whether the component is left after this period.
bool Session::is_enough(bool everybody_right) const {
  if (options_.mastery == MasteryRule::kAllRight) {
    return everybody_right && correct_in_a_row_ + 1 >= options_.consecutive_correct;
  }
  const auto before =
      std::find_if(history_.rbegin(), history_.rend(),
                   [&](const PastPeriod& period) { return period.lesson.component != lesson_.component; }) -
      history_.rbegin();
  const auto periods = static_cast<std::size_t>(before) + 1;  // of this component
  if (options_.mastery == MasteryRule::kFixed) return periods >= options_.periods_per_component;
  return periods >= options_.min_periods && mastery_ >= options_.probability;
}

// The answers of everybody who gave any, and the feedback that follows.
void Session::inform_bank(const Feedback& feedback, const std::vector<bool>& present) {
  if (!bank_) return;
  std::vector<std::vector<Answer>> answers(num_members());
  for (std::size_t i = 0; i < num_members(); ++i) {
    if (has_answered(i)) answers[i] = pending_[i]->answers;
  }
  bank_->close_tests(*atlas_, lesson_, answers, feedback, present);
  if (exam_) mastery_ = bank_->probability_of_mastery(*atlas_, *exam_, lesson_.component, present);
}

}  // namespace kith
