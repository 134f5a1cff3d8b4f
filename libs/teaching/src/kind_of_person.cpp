#include "kith/teaching/kind_of_person.hpp"

#include <algorithm>
#include <cmath>

#include "kith/teaching/known_components.hpp"

namespace kith {

std::vector<KindProbability> kinds_after(TeachingCache& cache, const TeachingOptions& options,
                                         std::span<const ObservedPeriod> periods, const RandomStream& random) {
  const auto& atlas = cache.atlas();
  const auto components = constraints_of_components(atlas);
  LearnerBank bank{cache.start_of(options), options.filter, options.likelihood, options.kinds, random, components};
  const ObservedPeriod* before = nullptr;
  for (const auto& period : periods) {
    if (period.is_exam()) {
      bank.see_answers(AnswerFit{atlas, period.tests, period.answers, period.verdicts});
      continue;
    }
    if (before == nullptr || before->component != period.component) bank.begin_component();
    if (before != nullptr) {
      const auto minutes =
          minutes_of(options.pace, before->demonstrations.size(), before->tests.size(), before->discussed);
      bank.let_time_pass(minutes, period.period);
    }
    std::vector<StartIndex> demos;
    std::vector<HalfSpace> conveyed;
    for (const auto& shown : period.demonstrations) {
      demos.push_back(shown.start);
      conveyed.insert(conveyed.end(), shown.half_spaces.begin(), shown.half_spaces.end());
    }
    bank.see(atlas, demos);
    bank.watch(conveyed, period.period);
    bank.see_answers(AnswerFit{atlas, period.tests, period.answers, period.verdicts});
    if (!period.feedback.empty()) bank.hear_feedback(period.all_correct, period.feedback, period.period);
    before = &period;
  }
  return bank.kinds();
}

std::string kinds_in_words(std::vector<KindProbability> kinds) {
  constexpr double kNegligible = 0.1, kPercent = 100.0;
  const auto word = kind_word(kinds);
  std::stable_sort(kinds.begin(), kinds.end(),
                   [](const auto& a, const auto& b) { return a.probability > b.probability; });
  std::string text;
  for (const auto& [kind, probability] : kinds) {
    if (probability < kNegligible) break;
    const auto share = std::to_string(std::lround(kPercent * probability)) + " %";
    if (kind == word) return kind + " (" + share + ")";
    text += (text.empty() ? "" : ", ") + kind + " " + share;
  }
  return text.empty() ? word : word + " (" + text + ")";
}

}  // namespace kith
