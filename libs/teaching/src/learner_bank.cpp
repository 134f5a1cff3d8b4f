#include "kith/teaching/learner_bank.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "kith/teaching/known_components.hpp"

namespace kith {
namespace {

constexpr double kHighestAbility = 0.95;  // that gains lead to
constexpr double kCertain = 1.0 - 1e-9;

}  // namespace

void require_hypotheses(std::span<const LearnerHypothesis> hypotheses) {
  if (hypotheses.empty()) throw std::invalid_argument{"LearnerHypothesis: there is none"};
  for (const auto& hypothesis : hypotheses) {
    const bool is_good = hypothesis.ability >= 0.5 && hypothesis.ability <= 1.0 && hypothesis.confirm_gain >= 0.0 &&
                         hypothesis.correct_gain >= 0.0 && hypothesis.probability > 0.0;
    if (!is_good) throw std::invalid_argument{"LearnerHypothesis: one is out of range"};
  }
}

std::vector<LearnerHypothesis> one_hypothesis() { return {LearnerHypothesis{}}; }

std::vector<LearnerHypothesis> grid_of_hypotheses() {
  std::vector<LearnerHypothesis> grid;
  for (const double ability : {0.62, 0.68, 0.74, 0.80, 0.86, 0.92}) {
    grid.push_back({ability, 0.01, 0.03, 1.0});
    grid.push_back({ability, 0.03, 0.055, 1.0});
  }
  return grid;
}

std::vector<LearnerHypothesis> grid_of_known_components(std::size_t num_components) {
  constexpr std::size_t kAllCombinations = 4, kMostComponents = 31;
  if (num_components > kMostComponents) throw std::invalid_argument{"grid_of_known_components: too many components"};
  const auto n = num_known_by_chance(num_components);
  std::vector<std::uint32_t> sets;
  if (n <= kAllCombinations) {
    for (std::uint32_t set = 0; set < 1u << n; ++set) sets.push_back(set);
  } else {
    sets.push_back(0);
    for (std::size_t k = 0; k < n; ++k) sets.push_back(1u << k);
    for (std::size_t k = 2; k <= n; ++k) sets.push_back((1u << k) - 1u);
  }
  std::vector<LearnerHypothesis> grid;
  for (const auto set : sets) {
    grid.emplace_back();
    grid.back().known = set;
  }
  return grid;
}

LearnerBank::LearnerBank(const PriorCover& cover, const FilterOptions& filter, LikelihoodForm likelihood,
                         std::vector<LearnerHypothesis> hypotheses, RandomStream random,
                         std::span<const std::vector<HalfSpace>> components)
    : likelihood_{likelihood},
      hypotheses_{std::move(hypotheses)},
      random_{random},
      beliefs_(hypotheses_.size(), ParticleBelief{cover, filter}),
      cells_(hypotheses_.size()) {
  require_hypotheses(hypotheses_);
  double sum = 0.0;
  for (const auto& hypothesis : hypotheses_) sum += hypothesis.probability;
  for (const auto& one : hypotheses_) {
    weights_.push_back(one.probability / sum);
    abilities_.push_back(one.ability);
  }
  if (hypotheses_.size() > 1) {
    others_ = NonLearners{beliefs_.front()};
    learns_ = 1.0 - others_.weight();
  }
  for (std::size_t h = 0; h < hypotheses_.size(); ++h) {
    if (hypotheses_[h].known == 0) continue;
    beliefs_[h].observe(known_half_spaces(components, hypotheses_[h].known),
                        HalfSpaceLikelihood{kAbilityOfKnowing, likelihood_, beliefs_[h].dimension()},
                        random_.split("known").split(h));
  }
}

void LearnerBank::begin_component() {
  for (std::size_t h = 0; h < hypotheses_.size(); ++h) abilities_[h] = hypotheses_[h].ability;
}

void LearnerBank::observe(std::size_t h, std::span<const HalfSpace> half_spaces, RandomStream random) {
  beliefs_[h].observe(half_spaces,
                      HalfSpaceLikelihood{std::min(abilities_[h], kCertain), likelihood_, beliefs_[h].dimension()},
                      random.split(h));
}

void LearnerBank::watch(std::span<const HalfSpace> half_spaces, std::size_t period) {
  if (has_begun_ && !others_.empty()) {
    const auto likeliest = std::max_element(weights_.begin(), weights_.end()) - weights_.begin();
    const double before = others_.weight();
    others_.begin_period(learns_, &beliefs_[static_cast<std::size_t>(likeliest)], {1.0});
    learns_ -= others_.weight() - before;
  }
  has_begun_ = true;
  for (std::size_t h = 0; h < beliefs_.size(); ++h) observe(h, half_spaces, random_.split("watch").split(period));
}

void LearnerBank::see_answers(const AnswerFit& fit) {
  if (hypotheses_.size() < 2 || fit.num_tests() == 0) return;  // there is nothing to tell apart
  double learns = 0.0;
  for (std::size_t h = 0; h < weights_.size(); ++h) {
    weights_[h] *= fit.of(beliefs_[h], cells_[h]).likelihood;
    learns += weights_[h];
  }
  for (double& weight : weights_) weight /= learns;
  others_.see_answers(fit);
  learns_ *= learns;
  const double sum = learns_ + others_.weight();
  learns_ /= sum;
  others_.scale(1.0 / sum);
}

void LearnerBank::hear_feedback(bool all_correct, std::span<const HalfSpace> half_spaces, std::size_t period) {
  for (std::size_t h = 0; h < hypotheses_.size(); ++h) {
    const auto& one = hypotheses_[h];
    const double grown = abilities_[h] + (all_correct ? one.confirm_gain : one.correct_gain);
    abilities_[h] = std::max(abilities_[h], std::min(grown, kHighestAbility));
    observe(h, half_spaces, random_.split("feedback").split(period));
  }
}

std::vector<MemberHypothesis> LearnerBank::as_members(bool begins) const {
  std::vector<MemberHypothesis> members;
  for (std::size_t h = 0; h < hypotheses_.size(); ++h) {
    const auto& one = hypotheses_[h];
    const double now = begins ? one.ability : abilities_[h];
    const double gain = (one.confirm_gain + one.correct_gain) / 2.0;
    members.push_back({weights_[h], &beliefs_[h], now, std::max(now, std::min(now + gain, kHighestAbility))});
  }
  return members;
}

double LearnerBank::expected_present_ability() const {
  double mean = 0.0;
  for (std::size_t h = 0; h < hypotheses_.size(); ++h) mean += weights_[h] * abilities_[h];
  return mean;
}

double LearnerBank::expected_ability() const {
  double mean = 0.0;
  for (std::size_t h = 0; h < hypotheses_.size(); ++h) mean += weights_[h] * hypotheses_[h].ability;
  return mean;
}

double LearnerBank::probability_of_knowing(std::size_t component) const {
  double sum = 0.0;
  for (std::size_t h = 0; h < hypotheses_.size(); ++h) {
    if ((hypotheses_[h].known >> component & 1u) != 0u) sum += weights_[h];
  }
  return sum;
}

// The abilities of the bank with the ranges they stand for, ascending.
std::vector<LearnerBank::AbilityBin> LearnerBank::ability_bins() const {
  std::vector<AbilityBin> bins;
  for (std::size_t h = 0; h < hypotheses_.size(); ++h) {
    const double ability = hypotheses_[h].ability;
    const auto known = std::find_if(bins.begin(), bins.end(), [&](const auto& bin) { return bin.low == ability; });
    if (known != bins.end()) {
      known->probability += weights_[h];
    } else {
      bins.push_back({ability, ability, weights_[h]});
    }
  }
  std::sort(bins.begin(), bins.end(), [](const auto& a, const auto& b) { return a.low < b.low; });
  std::vector<double> centres;
  for (const auto& bin : bins) centres.push_back(bin.low);
  for (std::size_t i = 0; i < bins.size(); ++i) {
    const double below = i > 0 ? (centres[i] - centres[i - 1]) / 2.0 : 0.0;
    const double above = i + 1 < bins.size() ? (centres[i + 1] - centres[i]) / 2.0 : 0.0;
    bins[i].low = centres[i] - (i > 0 ? below : above);
    bins[i].high = centres[i] + (i + 1 < bins.size() ? above : below);
  }
  return bins;
}

double LearnerBank::ability_quantile(double q) const {
  const auto bins = ability_bins();
  double below = 0.0;
  for (const auto& bin : bins) {
    if (below + bin.probability >= q && bin.probability > 0.0) {
      return bin.low + (bin.high - bin.low) * std::clamp((q - below) / bin.probability, 0.0, 1.0);
    }
    below += bin.probability;
  }
  return bins.back().high;
}

double LearnerBank::probability_of_ability(double at_least) const {
  double sum = 0.0;
  for (const auto& bin : ability_bins()) {
    const double width = bin.high - bin.low;
    const double share =
        width > 0.0 ? std::clamp((bin.high - at_least) / width, 0.0, 1.0) : (bin.low >= at_least ? 1.0 : 0.0);
    sum += bin.probability * share;
  }
  return sum;
}

std::vector<double> LearnerBank::cell_masses(const Atlas& atlas, double stopping) {
  std::vector<double> masses(atlas.tables().cells().size(), 0.0);
  for (std::size_t h = 0; h < hypotheses_.size(); ++h) {
    const auto cells = cells_[h].of(atlas, beliefs_[h]);
    const auto weights = beliefs_[h].weights();
    for (std::size_t i = 0; i < weights.size(); ++i) masses[cells[i]] += learns_ * weights_[h] * weights[i];
  }
  others_.add_cell_masses(atlas, masses, stopping);
  const double sum = learns_ + others_.weight(stopping);
  for (double& mass : masses) mass /= sum;
  return masses;
}

double LearnerBank::mass_in(std::span<const HalfSpace> half_spaces) const {
  double mass = 0.0;
  for (std::size_t h = 0; h < hypotheses_.size(); ++h) mass += weights_[h] * beliefs_[h].mass_in(half_spaces);
  mass *= learns_;
  for (const auto& [weight, share] : others_.shares(half_spaces)) mass += weight * share;
  return mass;
}

}  // namespace kith
