#include <algorithm>
#include <array>
#include <numeric>
#include <vector>

#include "imagined_people.hpp"
#include "kith/teaching/strategy.hpp"
#include "kith/teaching/teaching_options.hpp"
#include "kith/teaching/team_bank.hpp"
#include "lesson_loss.hpp"
#include "lesson_search.hpp"

namespace kith::detail {
namespace {

using Members = std::vector<std::vector<MemberHypothesis>>;

const std::array kPlanParameters{
    Parameter{.name = "people",
              .default_value = std::int64_t{8},
              .description = "people imagined from the prior to find out what a demonstration can convey, and as many "
                             "from the beliefs about the members",
              .min = 1,
              .max = 1000},
    Parameter{.name = "points",
              .default_value = std::int64_t{250},
              .description = "points drawn from the beliefs about each member to judge a lesson by",
              .min = 1,
              .max = 100'000},
    Parameter{.name = "demonstrations",
              .default_value = std::int64_t{3},
              .description = "demonstrations per lesson at most; teacher.max_demonstrations takes precedence",
              .min = 1,
              .max = 100},
    Parameter{.name = "tests",
              .default_value = std::int64_t{3},
              .description = "tests per lesson at most",
              .min = 1,
              .max = 100},
    Parameter{.name = "capacity",
              .default_value = std::int64_t{0},
              .description = "different constraints of a lesson that members are assumed to take in; 0: all",
              .max = 1000},
    Parameter{.name = "answers",
              .default_value = 0.5,
              .description = "weight of the teacher's belief about a member, which knows the answers, against those "
                             "of the hypotheses about the member"},
};

// What is best for people who imitate harms all others, and what is best on average is nearly that, as imitators have
// so much more at stake: of the two sorts only the likelier is left.
void leave_likelier_sort(std::vector<MemberHypothesis>& hypotheses) {
  const auto imitates = [](const MemberHypothesis& one) { return one.imitation.probability > 0.0; };
  double imitators = 0.0;
  for (const auto& one : hypotheses) imitators += imitates(one) ? one.weight : 0.0;
  const bool left = imitators > 0.5;
  for (auto& one : hypotheses) {
    one.weight = imitates(one) == left ? one.weight / (left ? imitators : 1.0 - imitators) : 0.0;
  }
}

// The members present with the hypotheses of the bank and, with the weight `answers`, the belief that knows the
// answers. The beliefs of the hypotheses are what people believe if the model is right, but only their weights depend
// on the answers; the informed belief depends on the answers itself, with the expected ability.
Members believed(const TeachingView& view, double answers) {
  Members members(view.bank->size());
  for (std::size_t i = 0; i < members.size(); ++i) {
    if (!view.belief.present()[i]) continue;
    const auto& bank = view.bank->member(i);
    MemberHypothesis mean{answers, &view.bank->informed(i), 0.0, 0.0};
    double temperature = 0.0;  // summed over the answers that are imitations
    auto hypotheses = bank.as_members(view.bank->begins(view.component));
    leave_likelier_sort(hypotheses);
    for (auto& one : hypotheses) {
      mean.shown_ability += one.weight * one.shown_ability;
      mean.feedback_ability += one.weight * one.feedback_ability;
      mean.imitation.probability += one.weight * one.imitation.probability;
      temperature += one.weight * one.imitation.probability * one.imitation.temperature;
      one.weight *= 1.0 - answers;
      members[i].push_back(one);
    }
    if (mean.imitation.probability > 0.0) mean.imitation.temperature = temperature / mean.imitation.probability;
    members[i].push_back(mean);
  }
  return members;
}

// The lesson that lowers what people get wrong most, per item.
class Plan : public Strategy {
 public:
  Plan(const ParameterValues& values, bool knows_truth)
      : people_{static_cast<std::size_t>(values.count("people"))},
        points_{static_cast<std::size_t>(values.count("points"))},
        limits_{.demonstrations = static_cast<std::size_t>(values.count("demonstrations")),
                .tests = static_cast<std::size_t>(values.count("tests")),
                .capacity = static_cast<std::size_t>(values.count("capacity"))},
        answers_{values.real("answers")},
        knows_truth_{knows_truth} {}

  [[nodiscard]] std::unique_ptr<Strategy> clone() const override { return std::make_unique<Plan>(*this); }

  [[nodiscard]] UnitProposal propose(const TeachingView& view, UnitSelector& select, RandomStream random) override {
    auto& cache = select.cache();
    auto members = believed(view, answers_);
    for (std::size_t i = 0; knows_truth_ && i < view.truth.size(); ++i) {
      const auto& truth = view.truth[i];
      if (members[i].empty() || truth.belief == nullptr) continue;
      members[i] = {{1.0, truth.belief, truth.shown_ability, truth.feedback_ability}};
    }
    LessonLoss loss{cache,
                    view.component,
                    members,
                    view.tie_breaks,
                    {.objective = view.options.objective, .likelihood = view.options.likelihood, .points = points_},
                    random.split("points")};
    auto limits = limits_;
    if (view.options.max_demonstrations > 0) limits.demonstrations = view.options.max_demonstrations;
    return best_lesson(cache, view, loss, imagined(cache, view, members, random.split("people")), limits,
                       random.split("lesson"));
  }

 private:
  // To whom demonstrations are imagined to be shown. Few people convey few constraints, which makes small, sharp
  // lessons; many convey all that a demonstration can. Somebody who only just misses a facet conveys the facet itself,
  // which nobody else may bring up.
  [[nodiscard]] std::vector<ImaginedPeople> imagined(TeachingCache& cache, const TeachingView& view,
                                                     const Members& members, RandomStream random) const {
    constexpr std::size_t kFew = 2;
    std::vector<std::size_t> order(members.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](auto a, auto b) { return view.tie_breaks[a] < view.tie_breaks[b]; });
    std::vector<const ParticleBelief*> beliefs;  // of every member the likeliest
    for (const auto i : order) {
      const auto likeliest = std::max_element(members[i].begin(), members[i].end(),
                                              [](const auto& a, const auto& b) { return a.weight < b.weight; });
      if (likeliest != members[i].end()) beliefs.push_back(likeliest->belief);
    }
    std::vector<ImaginedPeople> groups;
    constexpr double kSame = 0.5;  // the same people of the prior in every lesson, whose behaviour is known then
    groups.push_back(imagine_people(cache, beliefs, {.beliefs = people_}, kSame, random.split("beliefs")));
    groups.push_back(imagine_people(cache, beliefs, {people_, people_}, kSame, random.split("both")));
    groups.push_back(groups.back());
    const auto& facets = view.atlas.knowledge_components()[view.component].constraints;
    imagine_near_misses(cache, facets | view.atlas.prior(), facets, kMiss, groups.back());
    for (const auto* which : {"few", "few others"}) {
      groups.push_back(imagine_people(cache, beliefs, {.beliefs = kFew}, kSame, random.split(which)));
    }
    return groups;
  }

  std::size_t people_;
  std::size_t points_;
  LessonLimits limits_;
  double answers_;
  bool knows_truth_;
};

// The bank has beliefs of its own.
TeamBeliefNeeds plan_needs(const ParameterValues&) { return {.members = false, .rules = {}, .bank = true}; }

template <bool kKnowsTruth>
std::unique_ptr<Strategy> make_plan(const ParameterValues& parameters) {
  return std::make_unique<Plan>(parameters, kKnowsTruth);
}

}  // namespace

StrategyKind plan_kind() {
  return {.name = "plan",
          .description = "show and ask what lowers most, per item, what all members are expected to get wrong",
          .needs = plan_needs,
          .make = make_plan<false>,
          .parameters = kPlanParameters,
          .teaches_whole = true};
}

StrategyKind oracle_kind() {
  return {.name = "oracle",
          .description = "plan with what simulated people truly believe, for comparison",
          .needs = plan_needs,
          .make = make_plan<true>,
          .parameters = kPlanParameters,
          .needs_truth = true,
          .teaches_whole = true};
}

}  // namespace kith::detail
