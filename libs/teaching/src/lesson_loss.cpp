#include "lesson_loss.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "kith/core/math.hpp"
#include "kith/core/vector_clones.hpp"
#include "kith/teaching/exam_worth.hpp"

namespace kith {
namespace {

constexpr double kMostCertain = 1.0 - 1e-9;  // certainty could exclude every point
constexpr double kFloor = 0.001;             // of what people get wrong before teaching

KITH_VECTOR_CLONES void multiply_all(std::vector<double>& product, const std::vector<double>& factors) {
  double* const p = product.data();
  const double* const f = factors.data();
  KITH_INDEPENDENT_LOOP
  for (std::size_t i = 0; i < product.size(); ++i) p[i] *= f[i];
}

}  // namespace

LessonLoss::LessonLoss(TeachingCache& cache, std::size_t component,
                       std::span<const std::vector<MemberHypothesis>> members,
                       std::span<const std::uint64_t> tie_breaks, const Options& options, RandomStream random)
    : options_{options},
      constraints_{&cache.constraints()},
      dimension_{cache.atlas().domain().num_features()},
      axes_(dimension_) {
  std::vector<std::size_t> order(members.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](auto a, auto b) { return tie_breaks[a] < tie_breaks[b]; });
  for (const auto i : order) {
    double sum = 0.0, largest = 0.0;
    for (const auto& member : members[i]) {
      sum += member.weight;
      largest = std::max(largest, member.weight);
    }
    const bool counts = largest > 0.0;
    for (std::size_t h = 0; counts && h < members[i].size(); ++h) {
      const double share = members[i][h].weight / sum;
      if (share < options_.ignored && members[i][h].weight < largest) continue;
      const auto points = static_cast<std::size_t>(std::ceil(share * static_cast<double>(options_.points)));
      add_part(num_members_, members[i][h], points, random.split(tie_breaks[i]).split(h));
    }
    num_members_ += counts ? 1 : 0;
  }
  const auto wrong = [&](const Grade& grade) {
    return options_.objective == TeachingObjective::kRight ? 1.0 - grade.share_right : grade.regret;
  };
  const auto& worth = cache.worth_of(component);
  floor_ = std::max(kFloor * wrong(worth.before()), std::numeric_limits<double>::min());
  for (const auto& grade : worth.of(cache.behaviours(), axes_)) wrong_.push_back(wrong(grade));
}

Imitation LessonLoss::imitation() const {
  std::vector<double> weights(num_members_, 0.0);
  for (const auto& part : parts_) weights[part.member] += part.weight;
  Imitation all;
  double temperature = 0.0;
  for (const auto& part : parts_) {
    const double share = part.weight / (weights[part.member] * static_cast<double>(num_members_));
    all.probability += share * part.imitation.probability;
    temperature += share * part.imitation.probability * part.imitation.temperature;
  }
  if (all.probability > 0.0) all.temperature = temperature / all.probability;
  return all;
}

void LessonLoss::add_part(std::size_t member, const MemberHypothesis& hypothesis, std::size_t points,
                          RandomStream random) {
  const auto& belief = *hypothesis.belief;
  const auto begin = mass_.size();
  for (const auto& draw : belief.systematic_draws(points, random)) {
    for (std::size_t k = 0; k < dimension_; ++k) axes_[k].push_back(belief.axis(k)[draw.index]);
    mass_.push_back(static_cast<double>(draw.count));
  }
  parts_.push_back({member, hypothesis.weight, hypothesis.imitation, begin, mass_.size(),
                    likelihood_with(hypothesis.shown_ability), likelihood_with(hypothesis.feedback_ability)});
}

// Members alike have the same abilities.
HalfSpaceLikelihood LessonLoss::likelihood_with(double ability) {
  const auto known = likelihoods_.find(ability);
  if (known != likelihoods_.end()) return known->second;
  const HalfSpaceLikelihood made{std::min(ability, kMostCertain), options_.likelihood, dimension_};
  return likelihoods_.emplace(ability, made).first->second;
}

const LessonLoss::Factors& LessonLoss::factors(ConstraintIndex c) {
  const auto [place, is_new] = factors_.try_emplace(c.value());
  auto& known = place->second;
  if (!is_new) return known;
  std::vector<double> t(mass_.size(), 0.0);
  const auto normal = (*constraints_)[c].unit();
  for (std::size_t k = 0; k < dimension_; ++k) {
    const double entry = normal[static_cast<Eigen::Index>(k)];
    for (std::size_t i = 0; i < t.size(); ++i) t[i] += entry * axes_[k][i];
  }
  known.shown.assign(t.size(), 1.0);
  known.feedback.assign(t.size(), 1.0);
  for (const Part& part : parts_) {
    for (std::size_t i = part.begin; i < part.end; ++i) {
      if (t[i] >= 0.0) continue;
      known.shown[i] = math::exp(part.shown.log_relative(t[i]));
      known.feedback[i] = math::exp(part.feedback.log_relative(t[i]));
    }
  }
  return known;
}

void LessonLoss::show(Product& product, const ConstraintSet& conveyed) {
  for (const auto c : conveyed.members()) multiply_all(product, factors(c).shown);
}

void LessonLoss::repeat(Product& product, const ConstraintSet& feedback) {
  for (const auto c : feedback.members()) multiply_all(product, factors(c).feedback);
}

double LessonLoss::of(const Product& product, double of_imitating) const {
  std::vector<double> losses(num_members_, 0.0), weights(num_members_, 0.0);
  for (const Part& part : parts_) {
    double mass = 0.0, wrong = 0.0;
    for (std::size_t i = part.begin; i < part.end; ++i) {
      mass += product[i];
      wrong += product[i] * wrong_[i];
    }
    if (!(mass > 0.0)) continue;
    const double q = part.imitation.probability;
    losses[part.member] += part.weight * math::log((1.0 - q) * wrong / mass + q * of_imitating + floor_);
    weights[part.member] += part.weight;
  }
  double sum = 0.0, worst = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < num_members_; ++i) {
    const double loss = weights[i] > 0.0 ? losses[i] / weights[i] : 0.0;
    sum += loss;
    worst = std::max(worst, loss);
  }
  if (num_members_ == 0) return 0.0;
  return options_.objective == TeachingObjective::kWorstMember ? worst : sum / static_cast<double>(num_members_);
}

}  // namespace kith
