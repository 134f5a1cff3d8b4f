#include "kith/teaching/learner_bank.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "ability_limits.hpp"
#include "kith/teaching/known_components.hpp"

namespace kith {
namespace {

constexpr double kSureOfKind = 0.8;

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

namespace {

// Somebody who learns as the paper has it: knows some components beforehand, and gains ability.
class UsualLearner final : public PresumedLearner {
 public:
  // @param h  the number of the hypothesis: the address of what moves its points.
  UsualLearner(const LearnerHypothesis& hypothesis, const PresumedStart& start, const RandomStream& random,
               std::size_t h)
      : hypothesis_{hypothesis},
        likelihood_{start.likelihood},
        random_{random},
        h_{h},
        ability_{hypothesis.ability},
        belief_{start.cover, start.filter},
        now_{likelihood_with(ability_)} {
    if (hypothesis.known == 0) return;
    belief_.observe(known_half_spaces(start.components, hypothesis.known),
                    HalfSpaceLikelihood{kAbilityOfKnowing, likelihood_, belief_.dimension()},
                    random_.split("known").split(h_));
  }

  [[nodiscard]] std::unique_ptr<PresumedLearner> clone() const override {
    return std::make_unique<UsualLearner>(*this);
  }
  void begin_component() override { learn_with(hypothesis_.ability); }
  void watch(std::span<const HalfSpace> half_spaces, std::size_t period) override {
    observe(half_spaces, random_.split("watch").split(period));
  }
  void hear_feedback(bool all_correct, std::span<const HalfSpace> half_spaces, std::size_t period) override {
    const double grown = ability_ + (all_correct ? hypothesis_.confirm_gain : hypothesis_.correct_gain);
    learn_with(std::max(ability_, std::min(grown, detail::kHighestAbility)));
    observe(half_spaces, random_.split("feedback").split(period));
  }
  [[nodiscard]] double likelihood(const AnswerFit& fit, PointCells& cells) const override {
    return fit.of(belief_, cells).likelihood;
  }
  [[nodiscard]] const ParticleBelief& belief() const override { return belief_; }
  [[nodiscard]] double ability() const override { return ability_; }
  [[nodiscard]] MemberHypothesis as_member(bool begins) const override {
    const double now = begins ? hypothesis_.ability : ability_;
    const double gain = (hypothesis_.confirm_gain + hypothesis_.correct_gain) / 2.0;
    return {1.0, &belief_, now, std::max(now, std::min(now + gain, detail::kHighestAbility))};
  }

 private:
  void observe(std::span<const HalfSpace> half_spaces, const RandomStream& random) {
    belief_.observe(half_spaces, now_, random.split(h_));
  }
  void learn_with(double ability) {
    if (ability != ability_) now_ = likelihood_with(ability);
    ability_ = ability;
  }
  [[nodiscard]] HalfSpaceLikelihood likelihood_with(double ability) const {
    return HalfSpaceLikelihood{std::min(ability, detail::kCertain), likelihood_, belief_.dimension()};
  }

  LearnerHypothesis hypothesis_;
  LikelihoodForm likelihood_;
  RandomStream random_;
  std::size_t h_;
  double ability_;  // now
  ParticleBelief belief_;
  HalfSpaceLikelihood now_;  // at that ability
};

std::string_view kind_of(const LearnerHypothesis& hypothesis) {
  return hypothesis.kind ? std::string_view{hypothesis.kind->name} : kUsualKind;
}

// Sums weights by kind, in the order of the hypotheses.
std::vector<KindProbability> by_kind(std::span<const LearnerHypothesis> hypotheses, std::span<const double> weights) {
  std::vector<KindProbability> kinds;
  for (std::size_t h = 0; h < hypotheses.size(); ++h) {
    const auto name = kind_of(hypotheses[h]);
    auto known = std::find_if(kinds.begin(), kinds.end(), [&](const auto& one) { return one.kind == name; });
    if (known == kinds.end()) known = kinds.insert(kinds.end(), {std::string{name}, 0.0});
    known->probability += weights[h];
  }
  return kinds;
}

std::vector<double> shares_of(std::span<const LearnerHypothesis> hypotheses) {
  double sum = 0.0;
  for (const auto& one : hypotheses) sum += one.probability;
  std::vector<double> shares;
  for (const auto& one : hypotheses) shares.push_back(one.probability / sum);
  return shares;
}

}  // namespace

std::string kind_word(std::span<const KindProbability> kinds) {
  const auto sure =
      std::find_if(kinds.begin(), kinds.end(), [](const auto& one) { return one.probability >= kSureOfKind; });
  return sure == kinds.end() ? "cannot tell yet" : sure->kind;
}

std::vector<KindProbability> kinds_of(std::span<const LearnerHypothesis> hypotheses) {
  return by_kind(hypotheses, shares_of(hypotheses));
}

LearnerBank::LearnerBank(const PriorCover& cover, const FilterOptions& filter, LikelihoodForm likelihood,
                         std::vector<LearnerHypothesis> hypotheses, RandomStream random,
                         std::span<const std::vector<HalfSpace>> components)
    : hypotheses_{std::move(hypotheses)} {
  require_hypotheses(hypotheses_);
  weights_ = shares_of(hypotheses_);
  const PresumedStart start{cover, filter, likelihood, components};
  for (std::size_t h = 0; h < hypotheses_.size(); ++h) {
    const auto& one = hypotheses_[h];
    people_.push_back({one.kind ? one.kind->make(one, start, random.split("kind").split(h))
                                : std::make_unique<UsualLearner>(one, start, random, h)});
  }
  if (hypotheses_.size() > 1) {
    others_ = NonLearners{ParticleBelief{cover, filter}};
    learns_ = 1.0 - others_.weight();
  }
}

std::vector<KindProbability> LearnerBank::kinds() const { return by_kind(hypotheses_, weights_); }

template <typename Change>
void LearnerBank::change_all(Changed* changed, Change change, bool usual) {
  Changed own;
  if (changed == nullptr) changed = &own;
  for (std::size_t h = 0; h < people_.size(); ++h) {
    if (!usual && !hypotheses_[h].kind) continue;
    auto& one = people_[h];
    auto& next = (*changed)[one.person];
    if (!next) {
      auto copy = one.person->clone();
      change(*copy);
      next = std::move(copy);
    }
    one.person = next;
  }
}

void LearnerBank::begin_component(Changed* changed) {
  change_all(changed, [](PresumedLearner& person) { person.begin_component(); });
}

void LearnerBank::let_time_pass(double minutes, std::size_t period, Changed* changed) {
  change_all(
      changed, [&](PresumedLearner& person) { person.let_time_pass(minutes, period); }, false);
}

void LearnerBank::see(const Atlas& atlas, std::span<const StartIndex> demonstrations, Changed* changed) {
  change_all(
      changed, [&](PresumedLearner& person) { person.see(atlas, demonstrations); }, false);
}

void LearnerBank::watch(std::span<const HalfSpace> half_spaces, std::size_t period, Changed* changed) {
  if (has_begun_ && !others_.empty()) {
    const auto likeliest = std::max_element(weights_.begin(), weights_.end()) - weights_.begin();
    const double before = others_.weight();
    others_.begin_period(learns_, &belief(static_cast<std::size_t>(likeliest)), {1.0});
    learns_ -= others_.weight() - before;
  }
  has_begun_ = true;
  change_all(changed, [&](PresumedLearner& person) { person.watch(half_spaces, period); });
}

void LearnerBank::see_answers(const AnswerFit& fit) {
  if (hypotheses_.size() < 2 || fit.num_tests() == 0) return;  // there is nothing to tell apart
  double learns = 0.0;
  for (std::size_t h = 0; h < weights_.size(); ++h) {
    weights_[h] *= people_[h].person->likelihood(fit, people_[h].cells);
    learns += weights_[h];
  }
  for (double& weight : weights_) weight /= learns;
  others_.see_answers(fit);
  learns_ *= learns;
  const double sum = learns_ + others_.weight();
  learns_ /= sum;
  others_.scale(1.0 / sum);
}

void LearnerBank::hear_feedback(bool all_correct, std::span<const HalfSpace> half_spaces, std::size_t period,
                                Changed* changed) {
  change_all(changed, [&](PresumedLearner& person) { person.hear_feedback(all_correct, half_spaces, period); });
}

std::vector<MemberHypothesis> LearnerBank::as_members(bool begins) const {
  std::vector<MemberHypothesis> members;
  for (std::size_t h = 0; h < hypotheses_.size(); ++h) {
    members.push_back(people_[h].person->as_member(begins));
    members.back().weight = weights_[h];
  }
  return members;
}

double LearnerBank::expected_present_ability() const {
  double mean = 0.0;
  for (std::size_t h = 0; h < hypotheses_.size(); ++h) mean += weights_[h] * people_[h].person->ability();
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
    const auto cells = people_[h].cells.of(atlas, belief(h));
    const auto weights = belief(h).weights();
    for (std::size_t i = 0; i < weights.size(); ++i) masses[cells[i]] += learns_ * weights_[h] * weights[i];
  }
  others_.add_cell_masses(atlas, masses, stopping);
  const double sum = learns_ + others_.weight(stopping);
  for (double& mass : masses) mass /= sum;
  return masses;
}

double LearnerBank::mass_in(std::span<const HalfSpace> half_spaces) const {
  double mass = 0.0;
  for (std::size_t h = 0; h < hypotheses_.size(); ++h) mass += weights_[h] * belief(h).mass_in(half_spaces);
  mass *= learns_;
  for (const auto& [weight, share] : others_.shares(half_spaces)) mass += weight * share;
  return mass;
}

double LearnerBank::probability_that(const std::function<bool(const ParticleBelief&, double)>& holds) const {
  constexpr double kUnlikely = 1e-4;  // counts as not so
  double probability = 0.0;
  for (std::size_t h = 0; h < hypotheses_.size(); ++h) {
    if (weights_[h] < kUnlikely) continue;
    const double own = 1.0 - people_[h].person->as_member(false).imitation.probability;
    if (holds(belief(h), own)) probability += learns_ * weights_[h];
  }
  for (const auto& state : others_.states()) {
    if (state.weight >= kUnlikely && state.belief && holds(*state.belief, 1.0)) probability += state.weight;
  }
  return probability;
}

}  // namespace kith
