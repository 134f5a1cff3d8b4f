#include <algorithm>
#include <array>
#include <memory>
#include <utility>
#include <vector>

#include "kith/bec/transfer.hpp"
#include "kith/core/distributions.hpp"
#include "kith/core/math.hpp"
#include "like_bayesian.hpp"

namespace kith {
namespace {

// Does, with some probability, what the robot did in a demonstration that looked similar.
class ImitatingLearner final : public LikeBayesian {
 public:
  ImitatingLearner(BayesianLearner person, double reward, double temperature, const RandomStream& random)
      : LikeBayesian{std::move(person), random}, reward_{reward}, temperature_{temperature} {}

  [[nodiscard]] std::unique_ptr<Learner> clone() const override { return std::make_unique<ImitatingLearner>(*this); }
  [[nodiscard]] bool answers_as_believed() const override { return false; }

  [[nodiscard]] Imitation imitation() const override { return {1.0 - reward_, temperature_}; }

  void see(const Atlas& /*atlas*/, std::span<const StartIndex> demonstrations) override {
    shown_.insert(shown_.end(), demonstrations.begin(), demonstrations.end());
  }

  [[nodiscard]] std::optional<double> likelihood(const AnswerEvidence& evidence) const override {
    require_paths(evidence);
    if (shown_.empty()) return person_.likelihood(evidence);
    const auto& atlas = evidence.atlas();
    const auto& given = evidence.paths();
    std::vector<std::vector<double>> similarities;
    std::vector<std::vector<Transfer>> transfers(given.size());
    for (std::size_t t = 0; t < given.size(); ++t) {
      similarities.push_back(similarity(atlas, given[t].test));
      for (const auto start : shown_) transfers[t].push_back(transferred(atlas, start, given[t].test).value());
    }
    return mean_over_cells(*person_.belief(), evidence, [&](PolicyCellIndex cell) {
      double product = 1.0;
      for (std::size_t t = 0; t < given.size() && product > 0.0; ++t) {
        const auto own = atlas.tables().answer(given[t].test, cell);
        if (!own) return 0.0;
        double sum = 0.0, copies = 0.0;
        for (std::size_t d = 0; d < shown_.size(); ++d) {
          sum += similarities[t][d];
          if (path(atlas, transfers[t][d], cell, *own) == given[t].counts) copies += similarities[t][d];
        }
        product *= (*own == given[t].counts ? reward_ : 0.0) + (1.0 - reward_) * copies / sum;
      }
      return product;
    });
  }

 private:
  void change_answers(Response& response, Behaviours& behaviours, std::span<const StartIndex> tests,
                      std::size_t period) const override {
    if (!response.weights || shown_.empty()) return;
    const auto& atlas = behaviours.atlas();
    std::optional<PolicyCellIndex> cell;
    for (std::size_t t = 0; t < tests.size(); ++t) {
      auto& given = response.answers[t];
      auto random = random_.split("imitates").split(period).split(t);
      if (!given || uniform01(random) < reward_) continue;
      const auto copied = transferred(atlas, shown_[categorical(similarity(atlas, tests[t]), random)], tests[t]);
      if (copied && copied->rest && !cell) cell = behaviours.locate(*response.weights);
      if (copied) given = path(atlas, *copied, cell, *given);
    }
  }

  // exp(-distance / temperature) of every demonstration, the nearest having 1.
  [[nodiscard]] std::vector<double> similarity(const Atlas& atlas, StartIndex test) const {
    std::vector<double> values;
    for (const auto start : shown_) {
      values.push_back(static_cast<double>(atlas.domain().dissimilarity(atlas.id(start), atlas.id(test))));
    }
    const double least = *std::min_element(values.begin(), values.end());
    for (double& value : values) value = math::exp((least - value) / temperature_);
    return values;
  }

  // The whole path: what was copied, and one's own way from there; `own` if there is none.
  [[nodiscard]] static IntegerVector path(const Atlas& atlas, const Transfer& copied,
                                          const std::optional<PolicyCellIndex>& cell, const IntegerVector& own) {
    if (!copied.rest) return copied.counts;
    const auto rest = atlas.tables().answer(*copied.rest, *cell);
    return rest ? copied.counts + *rest : own;
  }

  double reward_;
  double temperature_;
  std::vector<StartIndex> shown_;
};

constexpr std::array kRewards{0.05, 0.2, 0.35, 0.5, 0.65, 0.8, 0.95};
constexpr std::array kTemperatures{0.5, 1.0, 2.0, 4.0};
constexpr std::array kImitatingFitted{FittedParameter{"reward", kRewards},
                                      FittedParameter{"temperature", kTemperatures}};

}  // namespace

const LearnerModel& imitating_model() {
  static const std::vector<Parameter> kParameters = with_bayesian_parameters({
      {.name = "reward",
       .default_value = 0.5,
       .description = "probability of answering by what one believes about the reward, and not by imitation",
       .source = "lage2019"},
      {.name = "temperature",
       .default_value = 2.0,
       .description =
           "demonstration d is imitated with probability proportional to exp(-distance / temperature), the distance "
           "being how different the pictures of its start and of the test are",
       .max = 1000.0,
       .min_is_open = true,
       .source = "lage2019"},
  });
  static const LearnerModel kModel = [] {
    auto model = like_bayesian("imitating",
                               "like bayesian, but sometimes the keys of a demonstration with a similar start are "
                               "pressed again, and one's own "
                               "way taken from where they lead",
                               kParameters, kImitatingFitted,
                               [](const ParameterValues& values, std::span<const double> traits,
                                  const LearnerStart& start, RandomStream random) -> std::unique_ptr<Learner> {
                                 return std::make_unique<ImitatingLearner>(
                                     bayesian_person(values, traits, start, random), values.real("reward"),
                                     values.real("temperature"), random);
                               });
    model.needs_paths = true;
    return model;
  }();
  return kModel;
}

}  // namespace kith
