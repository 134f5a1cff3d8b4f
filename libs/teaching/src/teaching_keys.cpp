// Every key of `[teacher]` and `[stop]` that is a field of TeachingOptions, in one place.

#include <array>
#include <numbers>

#include "kith/teaching/teaching_options.hpp"

namespace kith {

template <>
inline constexpr std::array kWordsFor<CounterfactualSampling>{
    WordFor{CounterfactualSampling::kSystematic, "systematic"}, WordFor{CounterfactualSampling::kSpread, "spread"}};
template <>
inline constexpr std::array kWordsFor<LikelihoodForm>{WordFor{LikelihoodForm::kDiscontinuous, "discontinuous"},
                                                      WordFor{LikelihoodForm::kContinuous, "continuous"}};
template <>
inline constexpr std::array kWordsFor<Scaffold>{WordFor{Scaffold::kOfStrategy, "strategy"},
                                                WordFor{Scaffold::kFeatures, "features"},
                                                WordFor{Scaffold::kNone, "none"}};
template <>
inline constexpr std::array kWordsFor<TeachingObjective>{WordFor{TeachingObjective::kRight, "right"},
                                                         WordFor{TeachingObjective::kRegret, "regret"},
                                                         WordFor{TeachingObjective::kWorstMember, "worst-member"}};
template <>
inline constexpr std::array kWordsFor<HypothesesAbout>{
    WordFor{HypothesesAbout::kAbility, "ability"}, WordFor{HypothesesAbout::kKnownComponents, "known-components"},
    WordFor{HypothesesAbout::kNothing, "average"}, WordFor{HypothesesAbout::kKinds, "kinds"}};

namespace {
constexpr double kManyPeriods = 100'000;
}

std::span<const OptionKey<TeachingOptions>> teacher_keys() {
  using T = TeachingOptions;
  static const std::array keys{
      option_key<T, &T::filter, &FilterOptions::particles>("particles", "particles of each of the teacher's beliefs",
                                                           {1, 1'000'000}),
      option_key<T, &T::counterfactuals>(
          "counterfactuals", "weights drawn from the belief to simulate what people expect (N)", {1, 100'000}),
      option_key<T, &T::sampling>("counterfactual_sampling",
                                  "how they are drawn: 'systematic' by mass, 'spread' far from each other"),
      option_key<T, &T::assumed_ability>("assumed_ability", "ability (beta) that the teacher assumes for everybody",
                                         {0.5, 1, false, true}),
      option_key<T, &T::likelihood>("likelihood",
                                    "form of the likelihood of a half-space: 'discontinuous' or 'continuous'"),
      option_key<T, &T::filter, &FilterOptions::process_noise>(
          "process_noise", "bandwidth factor of the kernel that moves particles after resampling (eta)", {0, 10.0}),
      option_key<T, &T::response_noise>("response_noise",
                                        "blur of the teacher's beliefs after test answers, in radians per axis (nu)",
                                        {0, std::numbers::pi}),
      option_key<T, &T::filter, &FilterOptions::resample_below>(
          "resample_below",
          "beliefs are resampled when the effective sample size falls below this share of the particles"),
      option_key<T, &T::reduce_before_update>(
          "reduce_before_update",
          "whether the common belief gets only the minimal set of the half-spaces that answers show"),
      option_key<T, &T::review>("review", "whether every component is taught as if nothing had been taught before"),
      option_key<T, &T::scaffold>(
          "scaffold",
          "'features': components one after the other; 'none': the last one alone; 'strategy': as it is made for"),
      option_key<T, &T::max_demonstrations>(
          "max_demonstrations", "demonstrations per lesson at most; 0: as many as the strategy wants", {0, 1000}),
      option_key<T, &T::objective>("objective", "what strategies that look ahead lower"),
      option_key<T, &T::hypotheses_about>("hypotheses",
                                          "what the teacher's hypotheses about a member differ in: 'ability', "
                                          "'known-components', 'kinds' of learners or, in nothing, 'average'"),
  };
  return keys;
}

std::span<const OptionKey<TeachingOptions>> stop_keys() {
  using T = TeachingOptions;
  static const std::array keys{
      option_key<T, &T::periods_per_component>("periods_per_component",
                                               "periods of every component, with mastery 'fixed'", {1, kManyPeriods}),
      option_key<T, &T::probability>(
          "probability",
          "how probable it has to be, with mastery 'posterior', that all members answer a random test correctly, with "
          "'exam', that all predict share_right of the starts, with 'regret', that all lose at most max_regret",
          {0, 1, true, true}),
      option_key<T, &T::share_right>(
          "share_right",
          "with mastery 'exam', the share of a component's starts that everybody has to predict correctly",
          {0, 1, true, true}, [](const T& options) { return options.mastery.kind.name == "exam"; }),
      option_key<T, &T::min_periods>("min_periods",
                                     "periods of a component at least, with mastery 'posterior', 'exam' or 'regret'",
                                     {1, kManyPeriods}),
      option_key<T, &T::max_periods>("max_periods", "periods after which a session ends at the latest",
                                     {1, kManyPeriods}),
      option_key<T, &T::consecutive_correct>(
          "consecutive_correct", "consecutive periods in which everybody must answer all tests correctly", {1, 1000}),
      option_key<T, &T::duplicate_sets>("duplicate_sets", "different sets of tests in a period", {1, 1000}),
  };
  return keys;
}

}  // namespace kith
