#include "kith/teaching/misconception_bank.hpp"

#include <algorithm>
#include <stdexcept>

#include "count_distribution.hpp"

namespace kith {
namespace {

// (a u + b v) / (a + b); u and v have the same shape.
std::vector<double> mixed(double a, const std::vector<double>& u, double b, const std::vector<double>& v) {
  std::vector<double> sum(u.size());
  for (std::size_t i = 0; i < u.size(); ++i) sum[i] = a + b > 0.0 ? (a * u[i] + b * v[i]) / (a + b) : u[i];
  return sum;
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
                        options.hypotheses, stream, std::span<const std::vector<HalfSpace>>{}, true);
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
  others_ = NonLearners{ParticleBelief{cache.cover(prior, options.filter.particles), options.filter}};
  for (std::size_t s = 0; s < banks_.size(); ++s) {
    const double state = s > 0 ? each : 1.0 - each * static_cast<double>(constraints_.size());
    auto& weights = weights_.emplace_back();
    for (const double weight : banks_[s].weights()) weights.push_back(state * weight);
    right_.emplace_back(weights.size(), std::vector{1.0});
  }
  scale_learners(1.0 - others_.weight());
}

void MisconceptionBank::scale_learners(double factor) {
  for (auto& state : weights_) {
    for (double& weight : state) weight *= factor;
  }
}

// A period begins, and some of those who learn everything stop, with the belief of the likeliest of them.
void MisconceptionBank::let_some_stop() {
  auto& weights = weights_.front();
  std::size_t likeliest = 0;
  double learn = 0.0;
  std::vector<double> right(right_.front().front().size(), 0.0);
  for (std::size_t h = 0; h < weights.size(); ++h) {
    right = mixed(learn, right, weights[h], right_.front()[h]);
    learn += weights[h];
    if (weights[h] > weights[likeliest]) likeliest = h;
  }
  const double before = others_.weight();
  others_.begin_period(learn, banks_.front().belief(likeliest), right);
  const double stopped = others_.weight() - before;
  for (double& weight : weights) weight *= 1.0 - stopped / learn;
}

void MisconceptionBank::observe(const Atlas& atlas, const ObservedPeriod& period) {
  std::vector<HalfSpace> conveyed;
  for (const auto& shown : period.demonstrations) {
    conveyed.insert(conveyed.end(), shown.half_spaces.begin(), shown.half_spaces.end());
  }
  const AnswerFit fit{atlas, period.tests, period.answers, period.verdicts};
  num_tests_ += fit.num_tests();
  num_right_ += fit.num_right();
  const bool begins = period.component != component_;
  if (component_ != kNone) let_some_stop();
  component_ = period.component;
  double sum = 0.0;
  for (std::size_t s = 0; s < banks_.size(); ++s) {
    auto& bank = banks_[s];
    if (begins) bank.begin_component();
    bank.watch(conveyed, period.period);
    if (fit.num_tests() > 0) {
      const auto ratings = bank.ratings(fit);
      for (std::size_t h = 0; h < ratings.size(); ++h) {
        weights_[s][h] *= ratings[h].likelihood;
        right_[s][h] = convolved(right_[s][h], ratings[h].right);
      }
    }
    for (const double weight : weights_[s]) sum += weight;
    bank.hear_feedback(period.all_correct, period.feedback, period.period);
  }
  if (fit.num_tests() > 0) others_.see_answers(fit);
  sum += others_.weight();
  scale_learners(1.0 / sum);
  others_.scale(1.0 / sum);
  if (!period.feedback.empty()) mend();
}

void MisconceptionBank::mend() {
  for (std::size_t s = 1; s < banks_.size(); ++s) {
    for (std::size_t h = 0; h < weights_[s].size(); ++h) {
      const double mended = mended_ * weights_[s][h];
      right_[0][h] = mixed(weights_[0][h], right_[0][h], mended, right_[s][h]);
      weights_[0][h] += mended;
      weights_[s][h] -= mended;
    }
  }
}

Agreement MisconceptionBank::agreement() const {
  std::vector<double> right(num_tests_ + 1, 0.0);
  const auto add = [&](double weight, const std::vector<double>& some) {
    for (std::size_t n = 0; n < some.size(); ++n) right[n] += weight * some[n];
  };
  for (std::size_t s = 0; s < weights_.size(); ++s) {
    for (std::size_t h = 0; h < weights_[s].size(); ++h) add(weights_[s][h], right_[s][h]);
  }
  for (const auto& state : others_.states()) add(state.weight, state.right);
  Agreement result{.tests = num_tests_, .right = num_right_};
  double squares = 0.0, fewer = 0.0, more = 0.0;
  for (std::size_t n = 0; n < right.size(); ++n) {
    const auto number = static_cast<double>(n);
    result.expected += number * right[n];
    squares += number * number * right[n];
    fewer += n < num_right_ ? right[n] : 0.0;
    more += n > num_right_ ? right[n] : 0.0;
  }
  result.variance = std::max(0.0, squares - result.expected * result.expected);
  if (num_tests_ > 0) result.p = std::min(1.0, 2.0 * std::min(fewer, more) + right[num_right_]);
  return result;
}

void MisconceptionBank::forget(double angle, const RandomStream& random) {
  for (std::size_t s = 0; s < banks_.size(); ++s) banks_[s].forget(angle, random.split(s));
  others_.forget(angle, random.split("others"));
}

double MisconceptionBank::probability_of_misconception(std::size_t j) const {
  double sum = 0.0;
  for (const double weight : weights_[j + 1]) sum += weight;
  return sum;
}

std::vector<WeightedShare> MisconceptionBank::shares(std::span<const HalfSpace> half_spaces, double stopping) const {
  constexpr double kIgnored = 1e-7;
  std::vector<WeightedShare> result;
  for (std::size_t s = 0; s < banks_.size(); ++s) {
    for (std::size_t h = 0; h < weights_[s].size(); ++h) {
      if (weights_[s][h] < kIgnored) continue;
      result.push_back({weights_[s][h], banks_[s].belief(h).mass_in(half_spaces)});
    }
  }
  const auto others = others_.shares(half_spaces, stopping);
  result.insert(result.end(), others.begin(), others.end());
  return result;
}

double MisconceptionBank::probability_of_violating(const HalfSpace& half_space) const {
  double all = 0.0;
  for (const auto& one : shares({&half_space, 1})) all += one.weight * (1.0 - one.share);
  return std::max(0.0, all - others_.weight_of_guessing());
}

double MisconceptionBank::probability_of(std::span<const HalfSpace> half_spaces) const {
  double sum = 0.0;
  for (const auto& one : shares(half_spaces)) sum += one.weight * one.share;
  return sum;
}

std::vector<Direction> MisconceptionBank::violators(const HalfSpace& constraint, std::size_t n) const {
  std::vector<Direction> points;
  std::vector<double> masses;
  const auto add = [&](double weight, const ParticleBelief& belief) {
    for (std::size_t i = 0; i < belief.size(); ++i) {
      const double mass = weight * belief.weights()[i];
      if (mass == 0.0 || constraint.contains(belief.point(i))) continue;
      points.push_back(belief.point(i));
      masses.push_back(mass);
    }
  };
  for (std::size_t s = 0; s < banks_.size(); ++s) {
    for (std::size_t h = 0; h < weights_[s].size(); ++h) add(weights_[s][h], banks_[s].belief(h));
  }
  for (const auto& state : others_.states()) {
    if (state.belief) add(state.weight, *state.belief);
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
