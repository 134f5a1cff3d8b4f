#include "kith/fit/kinds_fit.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "kith/belief/prior_cover.hpp"
#include "kith/core/error.hpp"
#include "kith/teaching/known_components.hpp"
#include "open_table.hpp"

namespace kith {
namespace {

constexpr double kKindTail = 0.05;
constexpr double kSureOfKind = 0.9;

// A learner model at one combination of what is fitted.
struct KindPoint {
  double ability = 0.7;
  std::vector<double> own;  // shape [LearnerModel::fitted]
};

std::vector<KindPoint> kind_points(const LearnerModel& model, const std::vector<double>& abilities) {
  std::vector<KindPoint> points;
  for (const double ability : abilities) points.push_back({ability, {}});
  for (const auto& fitted : model.fitted) {
    std::vector<KindPoint> all;
    for (const auto& point : points) {
      for (const double value : fitted.values) {
        all.push_back(point);
        all.back().own.push_back(value);
      }
    }
    points = std::move(all);
  }
  return points;
}

double mean_gain(const Spread& gain) {
  return gain.value ? *gain.value : gain.half_normal.value() * std::sqrt(2.0 / std::numbers::pi);
}

double log_mean_of_kinds(const std::vector<double>& logs) {
  const double top = *std::max_element(logs.begin(), logs.end());
  double sum = 0.0;
  for (const double x : logs) sum += std::exp(x - top);
  return top + std::log(sum / static_cast<double>(logs.size()));
}

// One kind, one person: the log-likelihoods of their answers at all points.
class KindReplay {
 public:
  KindReplay(const PersonLog& person, const KnownLearner& known, const PriorCover& cover, double slip)
      : person_{person}, known_{known}, cover_{cover}, slip_{slip} {
    for (const auto& period : person.periods) evidence_.emplace_back(*known.atlas, period.given);
  }

  [[nodiscard]] double log_likelihood(const LearnerModel& model, const KindPoint& point,
                                      const RandomStream& random) const {
    ParameterValues values{model.parameters};
    for (const auto& parameter : known_.parameters.declared()) {
      const auto i = static_cast<std::size_t>(&parameter - known_.parameters.declared().data());
      values.set(parameter.name, known_.parameters.values()[i]);
    }
    for (std::size_t i = 0; i < model.fitted.size(); ++i) set(values, model.fitted[i].name, point.own[i]);
    const std::vector<double> traits{point.ability, mean_gain(known_.parameters.spread("confirm_gain")),
                                     mean_gain(known_.parameters.spread("correct_gain"))};
    const LearnerStart start{.cover = [&](std::size_t) -> const PriorCover& { return cover_; },
                             .likelihood = known_.form,
                             .components = [&] { return constraints_of_components(*known_.atlas); }};
    const auto learner = model.make(values, traits, start, random);
    double sum = 0.0;
    for (std::size_t t = 0; t < person_.periods.size(); ++t) {
      const auto& period = person_.periods[t];
      if (t == 0 || period.component != person_.periods[t - 1].component) learner->begin_component();
      if (t > 0) learner->let_time_pass(person_.periods[t - 1].minutes, t + 1);
      learner->see(*known_.atlas, period.shown);
      learner->watch(period.conveyed, t + 1);
      if (!period.given.empty()) sum += kith::log_likelihood(*learner, evidence_[t], slip_);
      if (period.feedback) learner->hear_feedback(period.all_correct, period.taught, t + 1);
    }
    return sum;
  }

 private:
  // Whole numbers, too.
  static void set(ParameterValues& values, std::string_view name, double value) {
    const auto declared = values.declared();
    const auto one = std::find_if(declared.begin(), declared.end(), [&](const auto& p) { return p.name == name; });
    if (one != declared.end() && std::holds_alternative<std::int64_t>(one->default_value)) {
      values.set(name, static_cast<std::int64_t>(std::lround(value)));
    } else {
      values.set(name, value);
    }
  }

  const PersonLog& person_;
  const KnownLearner& known_;
  const PriorCover& cover_;
  double slip_;
  std::vector<AnswerEvidence> evidence_;  // shape [periods]
};

// Mean and quantiles of a parameter that takes some values, each standing for the range halfway to its neighbours.
KindParameter kind_parameter(std::string name, const std::map<double, double>& masses) {
  KindParameter result{std::move(name), 0.0, 0.0, 0.0};
  std::vector<double> values;
  for (const auto& [value, mass] : masses) {
    result.mean += value * mass;
    values.push_back(value);
  }
  // An end in the range of the smallest or the largest value is the value itself: it is not known what lies beyond.
  const auto quantile = [&](double q, bool is_lower) {
    double below = 0.0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double mass = masses.at(values[i]);
      const bool is_first = i == 0, is_last = i + 1 == values.size();
      const double low = is_first ? values[i] : (values[i - 1] + values[i]) / 2.0;
      const double high = is_last ? values[i] : (values[i] + values[i + 1]) / 2.0;
      if (below + mass >= q && mass > 0.0) {
        if ((is_first && is_lower) || (is_last && !is_lower)) return values[i];
        return low + (high - low) * std::clamp((q - below) / mass, 0.0, 1.0);
      }
      below += mass;
    }
    return values.back();
  };
  result.lower = quantile(kKindTail, true);
  result.upper = quantile(1.0 - kKindTail, false);
  return result;
}

std::vector<KindParameter> kind_parameters(const LearnerModel& model, const std::vector<KindPoint>& points,
                                           const std::vector<double>& logs) {
  const double total = log_mean_of_kinds(logs) + std::log(static_cast<double>(logs.size()));
  std::vector<std::map<double, double>> masses(1 + model.fitted.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double mass = std::exp(logs[i] - total);
    masses[0][points[i].ability] += mass;
    for (std::size_t k = 0; k < model.fitted.size(); ++k) masses[k + 1][points[i].own[k]] += mass;
  }
  std::vector<KindParameter> result{kind_parameter("ability", masses[0])};
  for (std::size_t k = 0; k < model.fitted.size(); ++k) {
    result.push_back(kind_parameter(std::string{model.fitted[k].name}, masses[k + 1]));
  }
  return result;
}

// The shares that make everybody's answers most probable.
std::vector<double> kind_shares(const std::vector<KindOfPerson>& people, std::size_t num_kinds) {
  constexpr int kRounds = 200;
  std::vector<double> shares(num_kinds, 1.0 / static_cast<double>(num_kinds));
  for (int round = 0; round < kRounds; ++round) {
    std::vector<double> next(num_kinds, 0.0);
    for (const auto& person : people) {
      double sum = 0.0;
      for (std::size_t k = 0; k < num_kinds; ++k) sum += shares[k] * person.probability[k];
      for (std::size_t k = 0; k < num_kinds; ++k) {
        next[k] += shares[k] * person.probability[k] / (sum * static_cast<double>(people.size()));
      }
    }
    shares = std::move(next);
  }
  return shares;
}

void name_kind(KindOfPerson& person) {
  const auto total = log_mean_of_kinds(person.log_evidence) + std::log(static_cast<double>(person.log_evidence.size()));
  for (const double one : person.log_evidence) person.probability.push_back(std::exp(one - total));
  const auto best = std::max_element(person.probability.begin(), person.probability.end());
  person.likeliest = static_cast<std::size_t>(best - person.probability.begin());
  person.is_unclear = *best < kSureOfKind;
}

std::vector<KindOfPopulation> kinds_of_population(const std::vector<const LearnerModel*>& models,
                                                  const std::vector<KindOfPerson>& people) {
  const auto shares = kind_shares(people, models.size());
  const auto n = static_cast<double>(people.size());
  std::vector<KindOfPopulation> kinds;
  for (std::size_t k = 0; k < models.size(); ++k) {
    KindOfPopulation one{.kind = std::string{models[k]->kind}, .share = shares[k]};
    double squares = 0.0;
    for (const auto& person : people) {
      const double difference = person.log_evidence[k] - person.log_evidence[0];
      one.log_evidence += person.log_evidence[k];
      one.difference += difference;
      squares += difference * difference;
      one.described += person.likeliest == k ? 1u : 0u;
    }
    const double variance = n > 1.0 ? std::max(0.0, squares - one.difference * one.difference / n) / (n - 1.0) : 0.0;
    one.difference_se = std::sqrt(variance * n);
    kinds.push_back(std::move(one));
  }
  return kinds;
}

void require_paths_of(const ResponseLogs& logs) {
  if (logs.people.empty()) {
    auto diagnostic = detail::fault("E0710", "there are no people to fit", "", 0, "give more logs");
    diagnostic.infeasible = true;
    throw Error{{diagnostic}};
  }
  const bool have_paths = std::all_of(logs.models.begin(), logs.models.end(),
                                      [](const KnownLearner& known) { return known.atlas != nullptr; });
  if (have_paths) return;
  throw Error{{detail::fault("E0714", "these logs do not tell which paths people saw and answered", "", 0,
                             "the kinds of people can be told from run folders and exports of sessions")}};
}

}  // namespace

KindsReport fit_kinds(const ResponseLogs& logs, const KindsOptions& options, LearnerModels models) {
  require_paths_of(logs);
  std::vector<const LearnerModel*> comparable;
  std::vector<std::vector<KindPoint>> points;
  for (const auto* model : models) {
    if (model->traits.size() != bayesian_model().traits.size()) continue;  // people who are described otherwise
    comparable.push_back(model);
    points.push_back(kind_points(*model, options.abilities));
  }
  std::vector<PriorCover> covers;
  covers.reserve(logs.models.size());
  for (const auto& known : logs.models) covers.emplace_back(known.prior, num_particles(known.parameters));

  KindsReport report;
  std::vector<KindOfPerson> people(logs.people.size());
  report.complete = for_each_index(people.size(), options.parallel, [&](std::size_t i) {
    const auto& log = logs.people[i];
    auto& person = people[i];
    person.id = log.id;
    person.type = log.type;
    person.answered = log.answered;
    const auto& known = logs.models.at(log.model);
    const KindReplay replay{log, known, covers[log.model], options.slip};
    const auto random = RandomStream{options.seed}.split("kinds").split(lessons_of(log));
    for (std::size_t k = 0; k < comparable.size(); ++k) {
      std::vector<double> likelihoods;
      for (const auto& point : points[k]) {
        std::vector<double> runs;
        for (std::size_t r = 0; r < options.replicates; ++r) {
          runs.push_back(replay.log_likelihood(*comparable[k], point, random.split(r)));
        }
        likelihoods.push_back(log_mean_of_kinds(runs));
      }
      person.log_evidence.push_back(log_mean_of_kinds(likelihoods));
      person.parameters.push_back(kind_parameters(*comparable[k], points[k], likelihoods));
    }
    name_kind(person);
  });
  if (!report.complete) return report;
  report.kinds = kinds_of_population(comparable, people);
  report.people = std::move(people);
  return report;
}

}  // namespace kith
