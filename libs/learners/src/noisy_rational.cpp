#include <algorithm>
#include <array>
#include <memory>
#include <utility>
#include <vector>

#include "kith/core/distributions.hpp"
#include "kith/core/math.hpp"
#include "like_bayesian.hpp"

namespace kith {
namespace {

constexpr std::size_t kOthers = 8;  // people whose paths come to mind, where behaviours are not tabulated

// Takes every path that could be best for somebody with a probability that grows with what it is worth to this person.
class NoisyRationalLearner final : public LikeBayesian {
 public:
  NoisyRationalLearner(BayesianLearner person, double rationality, std::vector<Direction> others,
                       const RandomStream& random)
      : LikeBayesian{std::move(person), random}, rationality_{rationality}, others_{std::move(others)} {}

  [[nodiscard]] std::unique_ptr<Learner> clone() const override {
    return std::make_unique<NoisyRationalLearner>(*this);
  }
  [[nodiscard]] bool answers_as_believed() const override { return false; }

  [[nodiscard]] std::optional<double> likelihood(const AnswerEvidence& evidence) const override {
    require_paths(evidence);
    const auto& atlas = evidence.atlas();
    const auto& given = evidence.paths();
    std::vector<std::vector<IntegerVector>> paths;
    std::vector<std::size_t> number;
    for (const auto& answer : given) {
      const auto& all = paths.emplace_back(atlas.tables().coverage_set(answer.test));
      number.push_back(static_cast<std::size_t>(std::find(all.begin(), all.end(), answer.counts) - all.begin()));
      if (number.back() == all.size()) return 0.0;  // best for nobody
    }
    return mean_over_weights(*person_.belief(), evidence, [&](const Direction& weights, PolicyCellIndex /*cell*/) {
      double product = 1.0;
      for (std::size_t t = 0; t < paths.size(); ++t) product *= shares_of(paths[t], weights, 1.0)[number[t]];
      return product;
    });
  }

 private:
  void change_answers(Response& response, Behaviours& behaviours, std::span<const StartIndex> tests,
                      std::size_t period) const override {
    if (!response.weights) return;
    const auto scale = static_cast<double>(behaviours.atlas().domain().count_scale());
    for (std::size_t t = 0; t < tests.size(); ++t) {
      auto& given = response.answers[t];
      if (!given) continue;
      auto random = random_.split("noise").split(period).split(t);
      const auto paths = paths_at(behaviours, tests[t], *given);
      given = paths[categorical(shares_of(paths, *response.weights, scale), random)];
    }
  }

  // The distinct paths that could be best for somebody, or, where they are not tabulated, one's own and those of some
  // others.
  [[nodiscard]] std::vector<IntegerVector> paths_at(Behaviours& behaviours, StartIndex test,
                                                    const IntegerVector& own) const {
    if (const auto* tables = behaviours.atlas().find_tables()) return tables->coverage_set(test);
    std::vector<IntegerVector> paths{own};
    for (const auto& weights : others_) {
      auto path = behaviours.answer(test, behaviours.locate(weights));
      if (path && std::find(paths.begin(), paths.end(), *path) == paths.end()) paths.push_back(*path);
    }
    return paths;
  }

  // exp(rationality * w . mu), normalised. @param scale  of the counts.
  [[nodiscard]] std::vector<double> shares_of(const std::vector<IntegerVector>& paths, const Direction& weights,
                                              double scale) const {
    std::vector<double> shares;
    for (const auto& path : paths) {
      shares.push_back(rationality_ / scale * dot(path, std::span{weights.data(), path.size()}));
    }
    const double top = *std::max_element(shares.begin(), shares.end());
    double sum = 0.0;
    for (double& share : shares) sum += share = math::exp(share - top);
    for (double& share : shares) share /= sum;
    return shares;
  }

  double rationality_;
  std::vector<Direction> others_;
};

std::unique_ptr<Learner> make_noisy_rational(const ParameterValues& values, std::span<const double> traits,
                                             const LearnerStart& start, RandomStream random) {
  const auto& cover = start.cover(num_particles(values));
  std::vector<Direction> others;
  for (std::size_t i = 0; i < kOthers; ++i) others.push_back(cover.point((2 * i + 1) * cover.size() / (2 * kOthers)));
  return std::make_unique<NoisyRationalLearner>(bayesian_person(values, traits, start, random),
                                                values.real("rationality"), std::move(others), random);
}

constexpr std::array kRationalities{1.0, 2.0, 3.0, 4.5, 7.0, 10.0, 15.0, 22.0, 33.0, 50.0};
constexpr std::array kNoisyRationalFitted{FittedParameter{"rationality", kRationalities}};

}  // namespace

const LearnerModel& noisy_rational_model() {
  static const std::vector<Parameter> kParameters = with_bayesian_parameters({
      {.name = "rationality",
       .default_value = 10.0,
       .description =
           "what a path is worth counts this much: with probability proportional to exp(rationality x return), weights "
           "having length 1",
       .max = 1000.0,
       .source = "ziebart2008"},
  });
  static const LearnerModel kModel = [] {
    auto model = like_bayesian("noisy-rational",
                               "like bayesian, but every path that is best for somebody may be taken, those that are "
                               "worth more to the person more often",
                               kParameters, kNoisyRationalFitted, make_noisy_rational);
    model.needs_paths = true;
    return model;
  }();
  return kModel;
}

}  // namespace kith
