#include "policy_fit.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "kith/bec/comparison.hpp"
#include "kith/core/hash.hpp"
#include "robot_plan.hpp"

namespace kith::detail {
namespace {

double slack(double value) { return kExplainTolerance * std::max(1.0, std::abs(value)); }

}  // namespace

double margin_of(const HalfSpace& half_space, const Weights& w) {
  const Direction normal = half_space.unit();
  return std::inner_product(w.begin(), w.end(), normal.begin(), 0.0);
}

Weights at_length_1(Weights w) {
  const double length = std::sqrt(std::inner_product(w.begin(), w.end(), w.begin(), 0.0));
  for (double& x : w) x /= length;
  return w;
}

double margin_of(const Cone& region, const Weights& w) {
  double least = 1.0;
  for (const HalfSpace& facet : region.facets()) least = std::min(least, margin_of(facet, w));
  return least;
}

PolicyFit::PolicyFit(const Domain& domain, const ObservedPolicy& policy) : domain_{domain}, policy_{policy} {
  const auto wrong = [] { throw std::invalid_argument{"infer_weights: the policy is not one of this domain"}; };
  if (policy_.probability.size() != domain_.num_mdps() || policy_.is_seen.size() != domain_.num_mdps()) wrong();
  for (std::size_t m = 0; m < domain_.num_mdps(); ++m) {
    const auto n = mdp(m).num_states();
    if (policy_.probability[m].size() != mdp(m).num_choices() || policy_.is_seen[m].size() != n) wrong();
    auto& likeliest = likeliest_.emplace_back(n, kNoChoice);
    for (std::size_t s = 0; s < n; ++s) {
      num_states_ += 1;
      if (mdp(m).choices(StateIndex{s}).size() == 1) likeliest[s] = 0;
      if (!is_seen(m, s)) continue;
      likeliest[s] = kNoChoice;
      num_seen_ += 1;
      const auto first =
          policy_.probability[m].begin() + static_cast<std::ptrdiff_t>(mdp(m).first_choice(StateIndex{s}));
      const auto last = first + static_cast<std::ptrdiff_t>(mdp(m).choices(StateIndex{s}).size());
      const auto at = std::max_element(first, last);
      const double other = 1.0 - std::accumulate(first, last, 0.0);  // of what is no choice
      if (at != last && *at > 0.0 && *at >= other) likeliest[s] = static_cast<std::uint32_t>(at - first);
    }
  }
  if (num_seen_ == 0) wrong();
}

std::vector<HalfSpace> PolicyFit::demands(std::size_t m, std::size_t s, const std::vector<IntegerVector>& counts,
                                          std::size_t taken) const {
  std::vector<HalfSpace> result;
  for (std::size_t c = 0; c < mdp(m).choices(StateIndex{s}).size(); ++c) {
    if (const auto half_space = gain(m, s, counts, taken, c)) result.push_back(*half_space);
  }
  return result;
}

std::optional<HalfSpace> PolicyFit::gain(std::size_t m, std::size_t s, const std::vector<IntegerVector>& counts,
                                         std::size_t taken, std::size_t other) const {
  const auto choices = mdp(m).choices(StateIndex{s});
  const auto rest = [&](StateIndex next) -> const IntegerVector& { return counts[next.value()]; };
  const auto scale = domain_.count_scale();
  return preference(counts_of(mdp(m), choices[taken], scale, rest) - counts_of(mdp(m), choices[other], scale, rest),
                    scale);
}

bool PolicyFit::takes(std::size_t m, std::size_t s, std::size_t choice) const {
  return is_seen(m, s) && policy_.probability[m][mdp(m).first_choice(StateIndex{s}) + choice] > 0.0;
}

double PolicyFit::worth(const Look& look, std::size_t m, const Weights& w, const Choice& choice) const {
  double value = 0.0;
  for (const Outcome& outcome : mdp(m).outcomes(choice)) {
    const auto phi = mdp(m).features(outcome);
    value += outcome.probability * (std::inner_product(w.begin(), w.end(), phi.begin(), 0.0) +
                                    mdp(m).discount() * look.plans[m].values[outcome.next.value()]);
  }
  return value;
}

bool PolicyFit::is_best(const Look& look, std::size_t m, std::size_t s, std::uint32_t choice) const {
  if (choice == kNoChoice) return false;
  const double value = look.plans[m].values[s];
  const auto at_1 = at_length_1(look.weights);
  return worth(look, m, at_1, mdp(m).choices(StateIndex{s})[choice]) >= value - slack(value);
}

bool PolicyFit::is_explained(const Look& look, std::size_t m, std::size_t s) const {
  return is_best(look, m, s, likeliest_[m][s]);
}

bool PolicyFit::explains_all_likeliest(const Look& look) const {
  for (std::size_t m = 0; m < domain_.num_mdps(); ++m) {
    for (std::size_t s = 0; s < likeliest_[m].size(); ++s) {
      if (is_seen(m, s) && !is_explained(look, m, s)) return false;
    }
  }
  return true;
}

Look PolicyFit::looked_at(Weights weights) {
  Look look;
  look.weights = std::move(weights);
  const auto w = at_length_1(look.weights);
  for (std::size_t m = 0; m < domain_.num_mdps(); ++m) {
    auto plan = behave(mdp(m), w, {.scale = domain_.count_scale()});
    if (!plan) return look;
    look.plans.push_back(*std::move(plan));
  }
  double share = 0.0;
  ListHash hash;
  for (std::size_t m = 0; m < domain_.num_mdps(); ++m) {
    for (std::size_t s = 0; s < likeliest_[m].size(); ++s) {
      hash.add(look.plans[m].choice[s]);
      if (!is_seen(m, s)) continue;
      const auto part = explained_at(look, m, s, w);
      share += part.share;
      look.loss += part.loss;
    }
  }
  look.share = share / static_cast<double>(num_seen_);
  look.loss /= static_cast<double>(num_seen_);
  behaviours_.insert(hash.value());
  return look;
}

PolicyFit::Part PolicyFit::explained_at(const Look& look, std::size_t m, std::size_t s, const Weights& w) const {
  const auto choices = mdp(m).choices(StateIndex{s});
  const auto first = mdp(m).first_choice(StateIndex{s});
  const double value = look.plans[m].values[s];
  Part part;
  for (std::size_t c = 0; c < choices.size(); ++c) {
    const double probability = policy_.probability[m][first + c];
    if (probability == 0.0) continue;
    const double lost = value - worth(look, m, w, choices[c]);
    if (lost <= slack(value)) {
      part.share += probability;
    } else {
      part.loss += probability * lost;
    }
  }
  return part;
}

}  // namespace kith::detail
