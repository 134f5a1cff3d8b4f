#include "kith/fit/fit.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <set>

#include "kith/core/error.hpp"
#include "open_table.hpp"

namespace kith {
namespace {

std::string figure(double value, int digits) {
  char text[32];
  static_cast<void>(std::snprintf(text, sizeof text, "%.*f", digits, value));
  return text;
}

PopulationLimits limits_of(const ResponseLogs& logs, const FitOptions& options) {
  PopulationLimits limits{.ability_min = options.ability_first, .ability_max = 0.5, .gain_max = options.gain_last};
  for (const auto& model : logs.models)
    limits.ability_max = std::max(limits.ability_max, model.parameters.real("ability_max"));
  limits.ability_max = std::min(limits.ability_max, options.ability_last);
  return limits;
}

// One population and the weights of its people.
struct Members {
  std::string name;
  std::vector<double> weights{};
  double share = 1.0;
};

[[noreturn]] void too_few(const std::string& what) {
  auto diagnostic =
      detail::fault("E0710", what, "", 0, "give more logs; several folders and files can be fitted together");
  diagnostic.infeasible = true;
  throw Error{{diagnostic}};
}

std::vector<Members> labelled_members(const ResponseLogs& logs) {
  std::set<std::string> labels;
  for (const auto& person : logs.people) labels.insert(person.type);
  std::vector<Members> result;
  for (const auto& label : labels) {
    Members members{.name = labels.size() == 1 && label.empty() ? "all" : label.empty() ? "unlabelled" : label};
    std::size_t count = 0;
    for (const auto& person : logs.people) {
      members.weights.push_back(person.type == label ? 1.0 : 0.0);
      count += person.type == label ? 1u : 0u;
    }
    if (count < 2) too_few("type '" + members.name + "' has one person; a population cannot be fitted to that");
    members.share = static_cast<double>(count) / static_cast<double>(logs.people.size());
    result.push_back(std::move(members));
  }
  return result;
}

std::vector<Members> mixed_members(const MixtureFit& mixture) {
  std::vector<Members> result;
  for (std::size_t k = 0; k < mixture.types.size(); ++k) {
    Members members{.name = "type " + std::to_string(k + 1), .weights = {}, .share = mixture.shares[k]};
    for (const auto& probability : mixture.probability) members.weights.push_back(probability[k]);
    result.push_back(std::move(members));
  }
  return result;
}

constexpr std::array kParameters{&PopulationParameters::ability_mean, &PopulationParameters::ability_sd,
                                 &PopulationParameters::confirm_scale, &PopulationParameters::correct_scale};

// Quantiles of each parameter over the draws, between order statistics where needed.
PopulationParameters quantiles(const std::vector<PopulationParameters>& draws, double probability) {
  PopulationParameters result;
  for (const auto parameter : kParameters) {
    std::vector<double> values;
    for (const auto& draw : draws) values.push_back(draw.*parameter);
    std::sort(values.begin(), values.end());
    const double place = probability * static_cast<double>(values.size() - 1);
    const auto below = static_cast<std::size_t>(place);
    const auto above = std::min(below + 1, values.size() - 1);
    const double share = place - static_cast<double>(below);
    result.*parameter = values[below] + share * (values[above] - values[below]);
  }
  return result;
}

// Where the maximum of the likelihood lies at an edge of what is searched; the search stops a little before it.
std::vector<std::string> edge_sentences(const PopulationParameters& best) {
  constexpr std::array<const char*, kParameters.size()> kNames{"mean ability", "sd of ability", "scale of confirm gain",
                                                               "scale of correct gain"};
  constexpr double kNear = 0.02;
  std::vector<std::string> sentences;
  for (std::size_t k = 0; k < kParameters.size(); ++k) {
    const double value = best.*kParameters[k];
    const double low = kSmallestPopulation.*kParameters[k], high = kLargestPopulation.*kParameters[k];
    const bool at_low = value <= (1.0 + kNear) * low, at_high = value >= (1.0 - kNear) * high;
    if (!at_low && !at_high) continue;
    sentences.push_back("the likelihood is largest at the edge of the values searched for the " +
                        std::string{kNames[k]} + " (" + figure(low, 3) + " to " + figure(high, 3) +
                        "): " + figure(value, 3) + " is not an estimate");
  }
  return sentences;
}

// What sets people apart but for their names.
std::string lessons_and_answers(const PersonLog& person) {
  auto text = lessons_of(person);
  for (const auto& period : person.periods) {
    text += period.all_correct ? '+' : '-';
    for (const auto& answer : period.answers) {
      text += answer.inside ? '+' : '-';
      for (const auto& half_space : answer.cone) text += to_string(half_space.normal());
    }
    for (const auto& given : period.given) text += to_string(given.counts);
  }
  return text + person.type;
}

constexpr const char* kWhyTheyDiffer =
    "posterior medians and the maximum of the likelihood differ where the answers say little: the median averages over "
    "all values that explain the answers, weighted by a prior (half-normal of scale 0.1 on sd and gains), and the "
    "maximum is the single likeliest point";

// Contraction below this is called nothing.
constexpr double kNothing = 0.1;

std::string learned_about(const std::string& what, double contraction) {
  const std::string percent = figure(100.0 * std::max(contraction, 0.0), 0) + " %";
  if (contraction < kNothing)
    return "the answers tell almost nothing about a single person's " + what + " (" + percent + " of its variance)";
  return "a person's answers remove " + percent + " of the population's variance of the " + what;
}

void describe(Identifiability& result) {
  const std::string p = result.gains.p < 0.001 ? "p < 0.001" : "p = " + figure(result.gains.p, 3);
  const std::string figures = "twice the log-likelihood ratio " + figure(result.gains.statistic, 2) + ", " + p;
  result.sentences.push_back(result.gains_apart
                                 ? "the scales of the two gains differ (" + figures + ")"
                                 : "these data cannot tell the gains apart: one scale for both explains the answers "
                                   "as well (" +
                                       figures + ")");
  result.sentences.push_back(learned_about("ability", result.ability));
  result.sentences.push_back(learned_about("gain after right answers", result.confirm_gain));
  result.sentences.push_back(learned_about("gain after wrong answers", result.correct_gain));
}

class Fitting {
 public:
  Fitting(const ResponseLogs& logs, const FitOptions& options, const LikelihoodTable& table)
      : logs_{logs}, options_{options}, table_{table}, surface_{table}, limits_{limits_of(logs, options)} {}

  FitReport run() {
    if (options_.num_types > 0) {
      mixture_ = fit_mixture(surface_, std::min(options_.num_types, logs_.people.size()), limits_);
      members_ = mixed_members(*mixture_);
    } else {
      members_ = labelled_members(logs_);
    }
    for (const auto& members : members_) add_type(members);
    for (std::size_t i = 0; i < logs_.people.size(); ++i) add_person(i);
    for (std::size_t k = 0; k < members_.size(); ++k) add_identifiability(k);
    compare_models();
    warn_of_noise();
    describe_sample();
    report_.why_estimates_differ = kWhyTheyDiffer;
    return std::move(report_);
  }

 private:
  void add_type(const Members& members) {
    TypeReport type;
    type.name = members.name;
    type.share = members.share;
    type.fit = fit_with_intervals(surface_, members.weights, limits_, GainModel::kFree);
    type.identifiability.gains = compare_gain_scales(surface_, members.weights, limits_);
    auto& masses = masses_.emplace_back();
    const auto random = RandomStream{options_.seed}.split("populations");
    const auto draws = draw_populations(surface_, members.weights, limits_, type.fit, options_.num_draws, random);
    for (const auto& population : draws) masses.push_back(masses_of(surface_, population, limits_, GainModel::kFree));
    type.lower = quantiles(draws, 0.025);
    type.median = quantiles(draws, 0.5);
    type.upper = quantiles(draws, 0.975);
    type.at_edge = edge_sentences(type.fit.parameters);
    report_.types.push_back(std::move(type));
  }

  void add_person(std::size_t i) {
    const auto& log = logs_.people[i];
    PersonReport person{.id = log.id,
                        .type = log.type,
                        .periods = log.periods.size(),
                        .answered = log.answered,
                        .correct = log.correct,
                        .type_probabilities = {},
                        .posterior = {}};
    std::vector<PopulationMasses> masses;
    std::vector<double> probabilities;
    for (std::size_t k = 0; k < members_.size(); ++k) {
      const double probability = mixture_ ? mixture_->probability[i][k] : members_[k].weights[i];
      if (mixture_) person.type_probabilities.push_back(probability);
      if (probability < 1e-6) continue;
      for (const auto& mass : masses_[k]) {
        masses.push_back(mass);
        probabilities.push_back(probability / static_cast<double>(masses_[k].size()));
      }
    }
    person.type_unclear = mixture_ && mixture_->types.size() > 1 &&
                          *std::max_element(person.type_probabilities.begin(), person.type_probabilities.end()) < 0.9;
    person.posterior = posterior_of(surface_, i, masses, probabilities);
    report_.people.push_back(std::move(person));
  }

  void add_identifiability(std::size_t k) {
    auto& result = report_.types[k].identifiability;
    double sum = 0.0;
    for (std::size_t i = 0; i < report_.people.size(); ++i) {
      const double weight = members_[k].weights[i];
      const auto& posterior = report_.people[i].posterior;
      sum += weight;
      result.ability += weight * posterior.ability.contraction();
      result.confirm_gain += weight * posterior.confirm_gain.contraction();
      result.correct_gain += weight * posterior.correct_gain.contraction();
      result.difference += weight * posterior.difference.contraction();
      result.gain_correlation += weight * posterior.gain_correlation;
    }
    for (double* value :
         {&result.ability, &result.confirm_gain, &result.correct_gain, &result.difference, &result.gain_correlation}) {
      *value /= sum;
    }
    result.gains_apart = result.gains.p < 0.05;
    describe(result);
  }

  // The average over few runs of a small filter is noisy, and noise passes for a difference between people.
  void warn_of_noise() {
    constexpr std::size_t kEnough = 500;
    std::size_t fewest = kEnough;
    for (const auto& model : logs_.models)
      fewest = std::min(fewest, num_particles(model.parameters) * options_.replicates);
    if (fewest >= kEnough) return;
    report_.sentences.push_back("with few particles and " + std::to_string(options_.replicates) +
                                " replicates the likelihood is noisy; more replicates make it surer");
  }

  // Where answers were told apart by a sample of paths: how well, and how noisy the likelihood is at its largest.
  void describe_sample() {
    if (!logs_.sample) return;
    const auto& sample = *logs_.sample;
    report_.sentences.push_back("answers are told apart by " + std::to_string(sample.paths) + " paths of " +
                                std::to_string(sample.weights) + " weights that people may hold; of the last " +
                                std::to_string(sample.checked) + " weights " +
                                figure(100.0 * static_cast<double>(sample.missed) /
                                           static_cast<double>(std::max<std::size_t>(sample.checked, 1)),
                                       2) +
                                " % took a path that was not yet among them");
    if (options_.replicates < 2) {
      report_.sentences.push_back("the Monte-Carlo error is not known with a single replicate; give two or more");
      return;
    }
    double sum = 0.0, largest = 0.0;
    for (std::size_t i = 0; i < logs_.people.size(); ++i) {
      const auto& row = table_.log_likelihood[i];
      const auto best = static_cast<std::size_t>(std::max_element(row.begin(), row.end()) - row.begin());
      sum += table_.standard_error[i][best];
      largest = std::max(largest, table_.standard_error[i][best]);
    }
    const double mean = sum / static_cast<double>(logs_.people.size());
    report_.sentences.push_back("Monte-Carlo error of a person's log-likelihood at its largest: " + figure(mean, 2) +
                                " on average, at most " + figure(largest, 2) + " (standard error over " +
                                std::to_string(options_.replicates) + " replicates)");
    constexpr double kTolerable = 0.3;  // docs/fitting.md has figures below and above it
    report_.is_too_noisy = mean > kTolerable;
    if (!report_.is_too_noisy) return;
    report_.sentences.push_back(
        "that is too noisy: do not trust these estimates, and their intervals are too narrow; take more "
        "replicates, or run studies with more particles");
  }

  void compare_models() {
    const auto folds = std::min(options_.folds, logs_.people.size());
    if (folds < 2) return;
    std::vector<std::string> labels;
    for (const auto& person : logs_.people) labels.push_back(person.type);
    report_.cross_validation = cross_validate(surface_, labels, limits_, folds, options_.seed,
                                              {.threads = options_.parallel.threads, .on_progress = {}});
    for (const auto& model : report_.cross_validation) {
      if (model.model == "full") continue;
      const std::string figures = " (" + figure(model.difference, 1) + " +- " + figure(model.difference_se, 1) + ")";
      const bool better = model.difference > 2.0 * model.difference_se;
      const bool worse = model.difference < -2.0 * model.difference_se;
      report_.sentences.push_back("people who were held out are predicted " +
                                  std::string{better  ? "better"
                                              : worse ? "worse"
                                                      : "as well"} +
                                  " by the model '" + model.model + "' " + (better || worse ? "than" : "as") +
                                  " by one population with two gains" + figures);
    }
  }

  const ResponseLogs& logs_;
  const FitOptions& options_;
  const LikelihoodTable& table_;
  LikelihoodSurface surface_;
  PopulationLimits limits_;
  std::optional<MixtureFit> mixture_;
  std::vector<Members> members_;
  std::vector<std::vector<PopulationMasses>> masses_;  // per type, of its possible populations
  FitReport report_;
};

}  // namespace

ParameterGrid grid_of(const FitOptions& options) {
  return make_grid(options.ability_first, options.ability_last, options.num_abilities, options.gain_last,
                   options.num_gains);
}

FitReport fit_learners(const ResponseLogs& logs, const FitOptions& options) {
  constexpr std::size_t kFewest = 3;
  if (logs.people.size() < kFewest) {
    too_few("too few people: a population needs at least 3, and there are " + std::to_string(logs.people.size()));
  }
  if (options.num_types == 0) static_cast<void>(labelled_members(logs));  // complain before the work
  // By what they did, so that neither their names nor the order of the files count.
  std::vector<std::pair<std::string, std::size_t>> order;
  for (std::size_t i = 0; i < logs.people.size(); ++i) order.emplace_back(lessons_and_answers(logs.people[i]), i);
  std::sort(order.begin(), order.end());
  auto in_order = logs;
  for (std::size_t i = 0; i < order.size(); ++i) in_order.people[i] = logs.people[order[i].second];
  const auto table = log_likelihoods(
      in_order, grid_of(options),
      {.replicates = options.replicates, .seed = options.seed, .slip = options.slip, .parallel = options.parallel});
  if (!table.complete) {
    FitReport stopped;
    stopped.complete = false;
    return stopped;
  }
  auto report = Fitting{in_order, options, table}.run();
  auto people = report.people;
  for (std::size_t i = 0; i < order.size(); ++i) people[order[i].second] = std::move(report.people[i]);
  report.people = std::move(people);
  return report;
}

std::string learner_section(char letter, const TypeReport& type) {
  const auto& p = type.median;
  std::string text = std::string{"[learner."} + letter + "]\n";
  text += "label = \"" + type.name + " (fitted to " + figure(type.fit.people, 0) + " people)\"\n";
  text += "ability = { mean = " + figure(p.ability_mean, 3) + ", sd = " + figure(p.ability_sd, 3) + ", min = 0.51 }\n";
  text += "confirm_gain = { half_normal = " + figure(p.confirm_scale, 3) + " }\n";
  text += "correct_gain = { half_normal = " + figure(p.correct_scale, 3) + " }\n";
  text += "gain_max = 0.16\nordered_gains = false\n";
  return text;
}

}  // namespace kith
