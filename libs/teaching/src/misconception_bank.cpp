#include "kith/teaching/misconception_bank.hpp"

#include <algorithm>
#include <stdexcept>

namespace kith {
namespace {

// The tests that the person answered; a test without an answer says nothing.
struct AnsweredTests {
  std::vector<Test> tests;
  std::vector<Answer> answers;
  std::vector<Verdict> verdicts;
};

AnsweredTests answered(const ObservedPeriod& period) {
  AnsweredTests result;
  for (std::size_t t = 0; t < period.tests.size() && t < period.answers.size(); ++t) {
    if (!period.answers[t]) continue;
    result.tests.push_back(period.tests[t]);
    result.answers.push_back(period.answers[t]);
    result.verdicts.push_back(period.verdicts[t]);
  }
  return result;
}

}  // namespace

std::vector<HalfSpace> constraints_to_learn(const Atlas& atlas) {
  std::vector<HalfSpace> result;
  for (const auto& component : atlas.knowledge_components()) {
    for (const auto& facet : atlas.constraints().half_spaces(component.constraints)) {
      if (!atlas.prior_cone().implies(facet)) result.push_back(facet);
    }
  }
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

MisconceptionBank::MisconceptionBank(TeachingCache& cache, const Options& options, const RandomStream& random)
    : mended_{options.mended} {
  const bool is_good = options.misconceived >= 0.0 && options.misconceived < 1.0 && mended_ >= 0.0 && mended_ <= 1.0;
  if (!is_good) throw std::invalid_argument{"MisconceptionBank: an option is out of range"};
  const auto add = [&](const Cone& prior, const RandomStream& stream) {
    banks_.emplace_back(cache.cover(prior, options.filter.particles), options.filter, options.likelihood,
                        options.hypotheses, stream);
  };
  const auto& prior = cache.atlas().prior_cone();
  add(prior, random.split("learns"));
  for (const auto& constraint : constraints_to_learn(cache.atlas())) {
    const auto beyond = prior.clipped(constraint.opposite());
    if (!beyond) continue;
    add(*beyond, random.split("misconception").split(constraints_.size()));
    constraints_.push_back(constraint);
  }
  const double each = constraints_.empty() ? 0.0 : options.misconceived / static_cast<double>(constraints_.size());
  for (std::size_t s = 0; s < banks_.size(); ++s) {
    const double state = s > 0 ? each : 1.0 - each * static_cast<double>(constraints_.size());
    auto& weights = weights_.emplace_back();
    for (const double weight : banks_[s].weights()) weights.push_back(state * weight);
  }
}

void MisconceptionBank::observe(const Atlas& atlas, const ObservedPeriod& period) {
  std::vector<HalfSpace> conveyed;
  for (const auto& shown : period.demonstrations) {
    conveyed.insert(conveyed.end(), shown.half_spaces.begin(), shown.half_spaces.end());
  }
  const auto given = answered(period);
  const bool begins = period.component != component_;
  component_ = period.component;
  double sum = 0.0;
  for (std::size_t s = 0; s < banks_.size(); ++s) {
    auto& bank = banks_[s];
    if (begins) bank.begin_component();
    bank.watch(conveyed, period.period);
    if (!given.tests.empty()) {
      const auto likelihoods = bank.likelihoods(atlas, given.tests, given.answers, given.verdicts);
      for (std::size_t h = 0; h < likelihoods.size(); ++h) weights_[s][h] *= weight_of_answers(likelihoods[h]);
    }
    for (const double weight : weights_[s]) sum += weight;
    bank.hear_feedback(period.all_correct, period.feedback, period.period);
  }
  for (auto& state : weights_) {
    for (double& weight : state) weight /= sum;
  }
  if (period.feedback.empty()) return;
  for (std::size_t s = 1; s < banks_.size(); ++s) {
    for (std::size_t h = 0; h < weights_[s].size(); ++h) {
      weights_[0][h] += mended_ * weights_[s][h];
      weights_[s][h] *= 1.0 - mended_;
    }
  }
}

void MisconceptionBank::forget(double angle, const RandomStream& random) {
  for (std::size_t s = 0; s < banks_.size(); ++s) banks_[s].forget(angle, random.split(s));
}

double MisconceptionBank::probability_of_misconception(std::size_t j) const {
  double sum = 0.0;
  for (const double weight : weights_[j + 1]) sum += weight;
  return sum;
}

std::vector<WeightedShare> MisconceptionBank::shares(std::span<const HalfSpace> half_spaces) const {
  constexpr double kIgnored = 1e-7;
  std::vector<WeightedShare> result;
  for (std::size_t s = 0; s < banks_.size(); ++s) {
    for (std::size_t h = 0; h < weights_[s].size(); ++h) {
      if (weights_[s][h] < kIgnored) continue;
      result.push_back({weights_[s][h], banks_[s].belief(h).mass_in(half_spaces)});
    }
  }
  return result;
}

double MisconceptionBank::probability_of(std::span<const HalfSpace> half_spaces) const {
  double sum = 0.0;
  for (const auto& one : shares(half_spaces)) sum += one.weight * one.share;
  return sum;
}

std::vector<Direction> MisconceptionBank::violators(const HalfSpace& constraint, std::size_t n) const {
  std::vector<Direction> points;
  std::vector<double> masses;
  for (std::size_t s = 0; s < banks_.size(); ++s) {
    for (std::size_t h = 0; h < weights_[s].size(); ++h) {
      const auto& belief = banks_[s].belief(h);
      for (std::size_t i = 0; i < belief.size(); ++i) {
        const double mass = weights_[s][h] * belief.weights()[i];
        if (mass == 0.0 || constraint.contains(belief.point(i))) continue;
        points.push_back(belief.point(i));
        masses.push_back(mass);
      }
    }
  }
  std::vector<Direction> drawn;
  if (points.empty() || n == 0) return drawn;
  const auto counts = systematic_counts(masses, n, 0.5);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (counts[i] > 0) drawn.push_back(points[i]);
  }
  return drawn;
}

}  // namespace kith
