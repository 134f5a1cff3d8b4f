#include "kith/teaching/non_learners.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "count_distribution.hpp"

namespace kith {
namespace {

constexpr double kNegligible = 1e-7;

double weight_of(const NonLearners::State& state, double stopping) {
  return state.odds == 0.0 ? stopping * state.weight : state.weight;
}

}  // namespace

NonLearners::NonLearners(const ParticleBelief& prior) {
  const double kLearn = 1.0 - kGuess - kLearnNothing;
  for (const auto guess : {AnswerFit::Guess::kSensible, AnswerFit::Guess::kAny}) {
    states_.push_back({.weight = kGuess / 2.0, .guess = guess, .odds = kGuess / 2.0 / kLearn});
  }
  states_.push_back({.weight = kLearnNothing, .belief = prior, .odds = kLearnNothing / kLearn});
}

double NonLearners::weight(double stopping) const noexcept {
  double sum = 0.0;
  for (const auto& state : states_) sum += weight_of(state, stopping);
  return sum;
}

double NonLearners::weight_of_guessing() const noexcept {
  double sum = 0.0;
  for (const auto& state : states_) sum += state.belief ? 0.0 : state.weight;
  return sum;
}

void NonLearners::begin_period(double learn, const ParticleBelief* belief, const std::vector<double>& right) {
  if (empty() || learn * kStop < kNegligible) return;
  for (const auto guess : {AnswerFit::Guess::kSensible, AnswerFit::Guess::kAny}) {
    states_.push_back({.weight = learn * kGuessOn / 2.0, .guess = guess, .right = right});
  }
  if (belief != nullptr) states_.push_back({.weight = learn * kStop, .belief = *belief, .right = right});
}

void NonLearners::see_answers(const AnswerFit& fit) {
  for (auto& state : states_) {
    const auto rating = state.belief ? fit.of(*state.belief, state.cells) : fit.of(state.guess);
    state.weight *= rating.likelihood;
    state.right = convolved(state.right, rating.right);
  }
}

void NonLearners::scale(double factor) {
  for (auto& state : states_) state.weight *= factor;
  std::erase_if(states_, [](const State& state) { return state.weight < kNegligible && state.odds == 0.0; });
}

double NonLearners::odds_of_learning(double learn) const noexcept {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& state : states_) {
    if (state.odds > 0.0 && state.weight > 0.0) least = std::min(least, learn * state.odds / state.weight);
  }
  return least;
}

std::vector<WeightedShare> NonLearners::shares(std::span<const HalfSpace> half_spaces, double stopping) const {
  std::vector<WeightedShare> result;
  for (const auto& state : states_) {
    if (state.weight < kNegligible) continue;
    result.push_back({weight_of(state, stopping), state.belief ? state.belief->mass_in(half_spaces) : 0.0});
  }
  return result;
}

void NonLearners::add_cell_masses(const Atlas& atlas, std::span<double> masses, double stopping) {
  for (auto& state : states_) {
    if (!state.belief || state.weight < kNegligible) continue;
    const auto cells = state.cells.of(atlas, *state.belief);
    const auto weights = state.belief->weights();
    for (std::size_t i = 0; i < weights.size(); ++i) masses[cells[i]] += weight_of(state, stopping) * weights[i];
  }
}

}  // namespace kith
