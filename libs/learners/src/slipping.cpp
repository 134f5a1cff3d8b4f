#include <algorithm>
#include <array>
#include <memory>
#include <utility>
#include <vector>

#include "kith/core/distributions.hpp"
#include "kith/domains/judgement.hpp"
#include "like_bayesian.hpp"

namespace kith {
namespace {

// What a wrong first key leads to: another action at the start, which costs something, and then the robot's way.
std::vector<IntegerVector> slips_at(const Atlas& atlas, StartIndex test) {
  std::vector<IntegerVector> slips;
  const auto id = atlas.id(test);
  const auto& robot = atlas.feature_counts(test);
  for (std::size_t choice = 0; choice < atlas.domain().mdp(id.mdp).choices(id.start).size(); ++choice) {
    const auto counts = atlas.deviation_counts(test, choice);
    if (!judge_path(atlas.domain(), robot, counts).is_right) slips.push_back(counts);
  }
  return slips;
}

bool is_right_answer(const Atlas& atlas, StartIndex test, const IntegerVector& counts) {
  return judge_path(atlas.domain(), atlas.feature_counts(test), counts).is_right;
}

// Who knows the robot's way presses a wrong key with probability slip; who does not takes it by luck with probability
// guess.
class SlippingLearner final : public LikeBayesian {
 public:
  SlippingLearner(BayesianLearner person, double slip, double guess, const RandomStream& random)
      : LikeBayesian{std::move(person), random}, slip_{slip}, guess_{guess} {}

  [[nodiscard]] std::unique_ptr<Learner> clone() const override { return std::make_unique<SlippingLearner>(*this); }
  [[nodiscard]] bool answers_as_believed() const override { return false; }

  [[nodiscard]] std::optional<double> likelihood(const AnswerEvidence& evidence) const override {
    require_paths(evidence);
    const auto& atlas = evidence.atlas();
    const auto& paths = evidence.paths();
    std::vector<std::vector<IntegerVector>> slips;
    for (const auto& given : paths) slips.push_back(slips_at(atlas, given.test));
    return mean_over_cells(*person_.belief(), evidence, [&](PolicyCellIndex cell) {
      double product = 1.0;
      for (std::size_t t = 0; t < paths.size(); ++t) {
        const auto own = atlas.tables().answer(paths[t].test, cell);
        product *= own ? probability(atlas, paths[t], *own, slips[t]) : 0.0;
      }
      return product;
    });
  }

 private:
  void change_answers(Response& response, Behaviours& behaviours, std::span<const StartIndex> tests,
                      std::size_t period) const override {
    const auto& atlas = behaviours.atlas();
    for (std::size_t t = 0; t < tests.size(); ++t) {
      auto& given = response.answers[t];
      if (!given) continue;
      auto random = random_.split("slips").split(period).split(t);
      const double chance = uniform01(random);
      if (!is_right_answer(atlas, tests[t], *given)) {
        if (chance < guess_) given = atlas.feature_counts(tests[t]);
      } else if (chance < slip_) {
        const auto slips = slips_at(atlas, tests[t]);
        if (!slips.empty()) given = slips[uniform_index(slips.size(), random)];
      }
    }
  }

  // Of giving an answer where one's own path is another, or the same.
  [[nodiscard]] double probability(const Atlas& atlas, const GivenAnswer& given, const IntegerVector& own,
                                   const std::vector<IntegerVector>& slips) const {
    const double same = own == given.counts ? 1.0 : 0.0;
    if (!is_right_answer(atlas, given.test, own)) {
      return (1.0 - guess_) * same + guess_ * (given.counts == atlas.feature_counts(given.test) ? 1.0 : 0.0);
    }
    if (slips.empty()) return same;
    const auto leading_there = static_cast<double>(std::count(slips.begin(), slips.end(), given.counts));
    return (1.0 - slip_) * same + slip_ * leading_there / static_cast<double>(slips.size());
  }

  double slip_;
  double guess_;
};

constexpr std::array kShares{0.02, 0.06, 0.1, 0.15, 0.2, 0.3, 0.4};
constexpr std::array kSlippingFitted{FittedParameter{"slip", kShares}, FittedParameter{"guess", kShares}};

}  // namespace

const LearnerModel& slipping_model() {
  static const std::vector<Parameter> kParameters = with_bayesian_parameters({
      {.name = "slip",
       .default_value = 0.1,
       .description = "probability of a wrong first key where the person knows the robot's way",
       .source = "corbett1994"},
      {.name = "guess",
       .default_value = 0.1,
       .description = "probability of taking the robot's way by luck where the person expects another",
       .source = "corbett1994"},
  });
  static const LearnerModel kModel = [] {
    auto model = like_bayesian(
        "slipping",
        "like bayesian, but sometimes a wrong key is pressed in spite of knowing better, and sometimes the right path "
        "is taken by luck",
        kParameters, kSlippingFitted,
        [](const ParameterValues& values, std::span<const double> traits, const LearnerStart& start,
           RandomStream random) -> std::unique_ptr<Learner> {
          return std::make_unique<SlippingLearner>(bayesian_person(values, traits, start, random), values.real("slip"),
                                                   values.real("guess"), random);
        });
    model.needs_paths = true;
    return model;
  }();
  return kModel;
}

}  // namespace kith
