#include "kith/teaching/misconception_bank.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <stdexcept>

#include "count_distribution.hpp"

namespace kith {
namespace {

constexpr double kTooUnlikely = 1e-7;

// The prior of every state of mind, and the constraints that those behind the first violate.
std::vector<Cone> priors_of(const Atlas& atlas, std::vector<HalfSpace>& violated) {
  std::vector<Cone> priors{atlas.prior_cone()};
  for (const auto& constraint : constraints_to_learn(atlas)) {
    auto beyond = priors.front().clipped(constraint.opposite());
    if (!beyond) continue;
    priors.push_back(*std::move(beyond));
    violated.push_back(constraint);
  }
  return priors;
}

// (a u + b v) / (a + b); u and v have the same shape.
std::vector<double> mixed(double a, const std::vector<double>& u, double b, const std::vector<double>& v) {
  if (a == 0.0) return v;
  if (b == 0.0) return u;
  std::vector<double> sum(u.size());
  for (std::size_t i = 0; i < u.size(); ++i) sum[i] = (a * u[i] + b * v[i]) / (a + b);
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

std::shared_ptr<LessonBeliefs> MisconceptionBank::beliefs(TeachingCache& cache, const Options& options,
                                                          const RandomStream& random) {
  std::vector<HalfSpace> violated;
  const auto priors = priors_of(cache.atlas(), violated);
  return std::make_shared<LessonBeliefs>(cache, options, priors, random);
}

MisconceptionBank::MisconceptionBank(const Atlas& atlas, const Options& options, std::shared_ptr<LessonBeliefs> beliefs)
    : mended_{options.mended}, beliefs_{std::move(beliefs)} {
  constexpr std::size_t kMany = 12, kFour = 4;
  const bool is_good = options.misconceived >= 0.0 && options.misconceived < 1.0 && mended_ >= 0.0 && mended_ <= 1.0;
  if (!is_good) throw std::invalid_argument{"MisconceptionBank: an option is out of range"};
  static_cast<void>(priors_of(atlas, constraints_));
  if (beliefs_->num_states() != constraints_.size() + 1) {
    throw std::invalid_argument{"MisconceptionBank: the beliefs are those of another domain"};
  }
  const auto& hypotheses = beliefs_->hypotheses();
  const auto n = hypotheses.size();
  stands_for_ = n >= kMany && n % kFour == 0 ? kFour : 1;
  double sum = 0.0;
  for (const auto& hypothesis : hypotheses) sum += hypothesis.probability;
  others_ = NonLearners{beliefs_->after(0, 0, 0).belief()};
  const double learn = 1.0 - others_.weight();
  const double misconceived = constraints_.empty() ? 0.0 : options.misconceived;
  for (std::size_t h = 0; h < n; ++h) {
    const double weight = learn * (1.0 - misconceived) * hypotheses[h].probability / sum;
    people_.push_back({.hypothesis = h, .weight = weight, .likelihood = 1.0});
  }
  for (std::size_t s = 1; s < beliefs_->num_states(); ++s) {
    for (std::size_t first = 0; first < n; first += stands_for_) {
      double probability = 0.0;
      for (std::size_t h = first; h < first + stands_for_; ++h) probability += hypotheses[h].probability / sum;
      people_.push_back({.state = s,
                         .hypothesis = first + stands_for_ / 2,
                         .weight = learn * misconceived / static_cast<double>(constraints_.size()) * probability});
    }
  }
}

KnownBelief& MisconceptionBank::belief(const People& people) const {
  return beliefs_->after(people.state, people.hypothesis, std::min(people.periods, num_periods_));
}

// A period begins, and some of those who learn everything stop.
void MisconceptionBank::let_some_stop() {
  double learn = 0.0;
  std::vector<double> right{1.0};
  for (const auto& person : people_) {
    if (!learns(person)) continue;
    right = mixed(learn, right, person.weight, person.right);
    learn += person.weight;
  }
  if (learn == 0.0) return;
  const double before = others_.weight();
  others_.begin_period(learn, nullptr, right);
  const double guess = (others_.weight() - before) / learn;
  for (std::size_t i = 0; i < beliefs_->hypotheses().size(); ++i) {
    auto stopped = people_[i];
    stopped.periods = num_periods_;
    stopped.weight *= NonLearners::kStop;
    people_[i].weight *= 1.0 - NonLearners::kStop - guess;
    if (stopped.weight > 0.0 || stopped.likelihood > 0.0) people_.push_back(std::move(stopped));
  }
}

void MisconceptionBank::observe(const Atlas& atlas, const ObservedPeriod& period) {
  if (!period.is_exam()) beliefs_->take(num_periods_, period);
  if (!period.is_exam() && num_periods_ > 0) let_some_stop();
  const AnswerFit fit{atlas, period.tests, period.answers, period.verdicts, AnswerFit::Missing::kIsWrong};
  num_tests_ += fit.num_tests();
  num_right_ += fit.num_right();
  if (fit.num_tests() > 0) weigh(atlas, fit, period.is_exam());
  if (period.is_exam()) {
    ++num_boards_;
    return;
  }
  ++num_periods_;
  if (!period.feedback.empty()) mend();
}

void MisconceptionBank::weigh(const Atlas& atlas, const AnswerFit& fit, bool is_exam) {
  double sum = 0.0, best = 0.0;
  const double learned = probability_of_learning();
  for (auto& person : people_) {
    if (person.weight == 0.0 && person.likelihood == 0.0) continue;
    auto& believed = person.periods == kGoesOn && !is_exam
                         ? beliefs_->answering(person.state, person.hypothesis, num_periods_)
                         : belief(person);
    const auto rating = believed.rating(atlas, fit);
    person.weight *= rating.likelihood;
    person.likelihood *= rating.likelihood;
    person.right = convolved(person.right, rating.right);
    sum += person.weight;
    best = std::max(best, person.likelihood);
  }
  if (learned > 0.0) {
    const double learns = probability_of_learning() / learned, guess = fit.of(AnswerFit::Guess::kSensible).likelihood;
    odds_against_halves_ *= 2.0 * learns / (learns + guess);
  }
  others_.see_answers(fit);
  sum += others_.weight();
  others_.scale(1.0 / sum);
  for (auto& one : people_) {
    one.weight /= sum;
    one.likelihood = best > 0.0 ? one.likelihood / best : 0.0;
    if (one.weight >= kTooUnlikely || one.likelihood >= kTooUnlikely) continue;
    one.weight = 0.0;
    one.likelihood = 0.0;
  }
}

void MisconceptionBank::mend() {
  for (auto& person : people_) {
    if (person.state == 0 || person.weight == 0.0) continue;
    const double mended = mended_ * person.weight / static_cast<double>(stands_for_);
    const auto first = person.hypothesis - stands_for_ / 2;
    for (std::size_t h = first; h < first + stands_for_; ++h) {
      people_[h].right = mixed(people_[h].weight, people_[h].right, mended, person.right);
      people_[h].weight += mended;
    }
    person.weight *= 1.0 - mended_;
  }
}

double MisconceptionBank::probability_of_learning() const noexcept {
  double sum = 0.0;
  for (const auto& person : people_) sum += person.periods == kGoesOn ? person.weight : 0.0;
  return sum;
}

double MisconceptionBank::odds_against_stopping(std::span<const HalfSpace> half_spaces,
                                                const CredibleLevelOptions& options) const {
  const auto& hypotheses = beliefs_->hypotheses();
  const auto enough = [&](const People& one) {
    return probability_of_enough(belief(one).mass_in(half_spaces), options);
  };
  double sum = 0.0, all = 0.0, often = 0.0;
  for (const auto& person : people_) {
    if (!learns(person)) continue;
    const double prior = hypotheses[person.hypothesis].probability;
    sum += prior;
    if (person.likelihood == 0.0) continue;
    all += prior * person.likelihood;
    often += prior * person.likelihood * enough(person);
  }
  if (!(all > 0.0)) return 0.0;
  double most = 0.0;
  for (const auto& one : people_) {
    if (one.periods == kGoesOn || one.likelihood == 0.0) continue;
    most = std::max(most, one.likelihood * (often / all - enough(one)));
  }
  return most > 0.0 ? all / sum / most : std::numeric_limits<double>::infinity();
}

Agreement MisconceptionBank::agreement() const {
  std::vector<double> right(num_tests_ + 1, 0.0);
  const auto add = [&](double weight, const std::vector<double>& some) {
    if (weight == 0.0) return;
    for (std::size_t n = 0; n < some.size(); ++n) right[n] += weight * some[n];
  };
  for (const auto& person : people_) add(person.weight, person.right);
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

double MisconceptionBank::probability_of_misconception(std::size_t j) const {
  double sum = 0.0;
  for (const auto& person : people_) sum += person.state == j + 1 ? person.weight : 0.0;
  return sum;
}

std::vector<WeightedShare> MisconceptionBank::shares(std::span<const HalfSpace> half_spaces) const {
  std::vector<WeightedShare> result;
  for (const auto& person : people_) {
    if (person.weight >= kTooUnlikely) result.push_back({person.weight, belief(person).mass_in(half_spaces)});
  }
  const auto others = others_.shares(half_spaces);
  result.insert(result.end(), others.begin(), others.end());
  return result;
}

std::vector<std::vector<WeightedShare>> MisconceptionBank::shares_after(double angle,
                                                                        std::span<const std::vector<HalfSpace>> lists,
                                                                        const RandomStream& random) const {
  constexpr double kNearlyAll = 0.99;
  std::vector<const People*> order;
  double left = kNearlyAll - others_.weight();
  for (const auto& person : people_) {
    if (person.weight >= kTooUnlikely) order.push_back(&person);
  }
  std::stable_sort(order.begin(), order.end(), [](auto* a, auto* b) { return a->weight > b->weight; });
  std::vector<std::vector<WeightedShare>> result;
  for (const auto& list : lists) result.push_back(others_.shares(list));
  for (const auto* one : order) {
    auto& now = belief(*one);
    const auto number = static_cast<std::size_t>(one - people_.data());
    auto later = left > 0.0 ? std::optional{now.belief()} : std::nullopt;
    if (later) later->diffuse(angle, random.split(number));
    for (std::size_t i = 0; i < lists.size(); ++i) {
      result[i].push_back({one->weight, later ? later->mass_in(lists[i]) : now.mass_in(lists[i])});
    }
    left -= one->weight;
  }
  return result;
}

double MisconceptionBank::probability_of_violating(const HalfSpace& half_space) const {
  double all = 0.0;
  for (const auto& share : shares({&half_space, 1})) all += share.weight * (1.0 - share.share);
  return std::max(0.0, all - others_.weight_of_guessing());
}

double MisconceptionBank::probability_of(std::span<const HalfSpace> half_spaces) const {
  double sum = 0.0;
  for (const auto& share : shares(half_spaces)) sum += share.weight * share.share;
  return sum;
}

std::vector<PossiblePerson> MisconceptionBank::possible_people(double least) const {
  using Kind = PossiblePerson::Kind;
  for (std::size_t h = 0; h < beliefs_->hypotheses().size(); ++h) {
    for (std::size_t s = 0; s < beliefs_->num_states(); ++s) static_cast<void>(beliefs_->after(s, h, num_periods_));
  }
  std::vector<PossiblePerson> result;
  for (const auto& person : people_) {
    if (person.weight < least) continue;
    const auto kind = person.state > 0            ? Kind::kMisconceives
                      : person.periods == kGoesOn ? Kind::kLearns
                                                  : Kind::kDoesNotLearn;
    result.push_back({person.weight, kind, &belief(person)});
  }
  for (const auto& state : others_.states()) {
    if (state.weight < least) continue;
    if (state.belief) {  // the prior
      result.push_back({state.weight, Kind::kDoesNotLearn, &beliefs_->after(0, 0, 0)});
    } else {
      result.push_back({state.weight, Kind::kGuesses, nullptr, state.guess});
    }
  }
  return result;
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
  for (const auto& person : people_) {
    if (person.weight >= kTooUnlikely) add(person.weight, belief(person).belief());
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
