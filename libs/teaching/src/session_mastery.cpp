// When a component has been taught enough, and who the members may be.

#include <algorithm>
#include <string>

#include "kith/teaching/known_components.hpp"
#include "kith/teaching/session.hpp"

namespace kith {

void Session::make_bank(TeachingCache& cache) {
  const bool stops = options_.mastery == MasteryRule::kPosterior || options_.release == ReleaseRule::kPosterior;
  if (stops && atlas_->is_tabulated()) exam_ = cache.shared_exam();
  if (options_.hypotheses_about == HypothesesAbout::kKnownComponents)
    options_.hypotheses = grid_of_known_components(atlas_->knowledge_components().size());
  if (options_.hypotheses_about == HypothesesAbout::kNothing) options_.hypotheses = one_hypothesis();
  if (!stops && !options_.keep_bank && !choice_.kind.needs(choice_.parameters).bank) return;
  bank_.emplace(cache.cover(atlas_->prior_cone(), options_.filter.particles), options_.filter, options_.likelihood,
                options_.hypotheses, persons_, options_.response_noise, constraints_of_components(*atlas_));
}

bool Session::awaits_newcomer() const {
  for (std::size_t i = 0; i < num_members(); ++i) {
    if (is_new_[i] && seats_[i] == Seat::kReturning) return true;
  }
  return false;
}

// Nothing is known about them, whatever was known about those who had their places.
void Session::admit_newcomers(TeachingCache& cache) {
  const auto& cover = cache.cover(atlas_->prior_cone(), options_.filter.particles);
  for (std::size_t i = 0; i < num_members(); ++i) {
    if (!is_new_[i] || seats_[i] != Seat::kReturning) continue;
    belief_.restart(i, cover);
    if (judged_) judged_->restart(i, cover);
    if (bank_) {
      bank_->restart(i, cover, options_.filter, options_.hypotheses, persons_[i], constraints_of_components(*atlas_));
    }
    right_in_a_row_[i] = 0;
    is_new_[i] = false;
  }
}

// Periods of the present component, with this one.
std::size_t Session::periods_of_component() const {
  std::size_t n = 1;
  for (auto past = history_.end(); past != history_.begin() && (--past)->lesson.component == lesson_.component;) ++n;
  return n;
}

// Whether the answers of these members tell them from people whom lessons do not reach. Such people would otherwise
// count as done after a few lucky answers, because most people learn.
bool Session::shows_learning(const std::vector<bool>& present) const {
  constexpr double kShare = 0.2;  // of 1 - probability
  return !bank_ || bank_->shows_learning(present, kShare * (1.0 - options_.probability));
}

// Whether the component is left after this period.
bool Session::is_enough(bool everybody_right, const std::vector<bool>& present) const {
  if (options_.mastery == MasteryRule::kAllRight) {
    return everybody_right && correct_in_a_row_ + 1 >= options_.consecutive_correct;
  }
  const auto periods = periods_of_component();
  if (options_.mastery == MasteryRule::kFixed) return periods >= options_.periods_per_component;
  if (periods < options_.min_periods) return false;
  if (options_.mastery == MasteryRule::kExam) return least_share_right_ >= options_.share_right;
  return mastery_ >= options_.probability && shows_learning(present);
}

// Whether components are left by what the teacher believes about the members: by the exam, and, where behaviours are
// not tabulated, by the posterior, because lessons stop showing what answers prove to be known, and beliefs of the bank
// never learn of that.
bool Session::reads_beliefs() const {
  if (options_.mastery == MasteryRule::kExam) return true;
  const bool stops = options_.mastery == MasteryRule::kPosterior || options_.release == ReleaseRule::kPosterior;
  return stops && !atlas_->is_tabulated();
}

// The beliefs by which components are left, and the starts at which they are judged. They are not blurred after
// answers: in many dimensions a region is narrower than `response_noise`, so that blurred mass never gathers in it.
void Session::make_judged(TeachingCache& cache) {
  if (!reads_beliefs()) return;
  auto options = belief_.options();
  options.response_noise = 0.0;
  options.members = true;
  options.rules.clear();
  judged_.emplace(cache.cover(atlas_->prior_cone(), options_.filter.particles), options, persons_,
                  teacher_.split("judged belief"));
  for (std::size_t k = 0; k < components_.size(); ++k) {
    starts_.push_back(options_.mastery == MasteryRule::kExam ? cache.starts_of(k) : cache.tests_of(k));
  }
}

// What the members present are expected to predict right after the feedback that they are about to get.
void Session::judge_beliefs(const Feedback& feedback, const std::vector<bool>& present) {
  TeamBelief after = *judged_;
  if (after.present() != present) after.set_present(present);
  after.observe_feedback(feedback.half_spaces, lesson_.period);
  const auto& sample = *starts_[lesson_.component];
  std::vector<std::vector<double>> all(sample.size());  // per start the members' probabilities
  std::vector<double> shares(num_members(), 0.0);
  least_share_right_ = 1.0;
  for (std::size_t i = 0; i < num_members(); ++i) {
    if (!present[i]) continue;
    const auto right = sample.probabilities_right(after.member(i));
    for (std::size_t s = 0; s < right.size(); ++s) {
      shares[i] += sample.weight(s) * right[s];
      all[s].push_back(right[s]);
    }
    least_share_right_ = std::min(least_share_right_, shares[i]);
  }
  right_alone_ = shares;
  if (options_.mastery == MasteryRule::kExam) return;
  mastery_ = 0.0;
  for (std::size_t s = 0; s < all.size(); ++s) {
    std::sort(all[s].begin(), all[s].end());  // so that seats do not matter
    double together = sample.weight(s);
    for (const double right : all[s]) together *= right;
    mastery_ += together;
  }
}

// The members present who are done with the component; nobody unless members are released.
std::vector<std::size_t> Session::done_members(const Feedback& feedback, const std::vector<bool>& present) {
  std::vector<std::size_t> done;
  if (options_.release == ReleaseRule::kNone) return done;
  if (options_.release == ReleaseRule::kPosterior && periods_of_component() < options_.min_periods) return done;
  for (std::size_t i = 0; i < num_members(); ++i) {
    if (!present[i]) continue;
    bool is_done = feedback.all_correct[i] && right_in_a_row_[i] + 1 >= options_.consecutive_correct;
    if (options_.release == ReleaseRule::kPosterior) {
      std::vector<bool> alone(num_members(), false);
      alone[i] = true;
      const double right =
          exam_ ? bank_->probability_of_mastery(*atlas_, *exam_, lesson_.component, alone) : right_alone_[i];
      is_done = right >= options_.probability && shows_learning(alone);
    }
    if (is_done) done.push_back(i);
  }
  return done;
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
