#include "kith/teaching/unit_value.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "kith/core/vector_clones.hpp"

namespace kith {
namespace {

constexpr double kMostCertain = 1.0 - 1e-9;  // certainty could exclude every point

KITH_VECTOR_CLONES void multiply(std::vector<double>& product, const std::vector<double>& factors) {
  double* const p = product.data();
  const double* const f = factors.data();
  KITH_INDEPENDENT_LOOP
  for (std::size_t i = 0; i < product.size(); ++i) p[i] *= f[i];
}

}  // namespace

UnitValue::UnitValue(TeachingCache& cache, std::size_t component,
                     std::span<const std::vector<MemberHypothesis>> members, std::span<const std::uint64_t> tie_breaks,
                     const Options& options, RandomStream random)
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
  grade_points(cache, component);
}

Imitation UnitValue::imitation() const {
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

void UnitValue::add_part(std::size_t member, const MemberHypothesis& hypothesis, std::size_t points,
                         RandomStream random) {
  const auto& belief = *hypothesis.belief;
  const auto begin = mass_.size();
  for (const auto& draw : belief.systematic_draws(points, random)) {
    for (std::size_t k = 0; k < dimension_; ++k) axes_[k].push_back(belief.axis(k)[draw.index]);
    mass_.push_back(static_cast<double>(draw.count));
  }
  parts_.push_back(
      {member, hypothesis.weight, hypothesis.imitation, begin, mass_.size(),
       HalfSpaceLikelihood{std::min(hypothesis.shown_ability, kMostCertain), options_.likelihood, dimension_},
       HalfSpaceLikelihood{std::min(hypothesis.feedback_ability, kMostCertain), options_.likelihood, dimension_}});
}

void UnitValue::grade_points(TeachingCache& cache, std::size_t component) {
  const auto& atlas = cache.atlas();
  worth_.assign(mass_.size(), 0.0);
  if (const auto* tables = atlas.find_tables()) {
    const auto& table = *cache.exam().table();
    for (std::size_t i = 0; i < worth_.size(); ++i) {
      const auto cell = tables->cells().locate(Eigen::Vector3d{axes_[0][i], axes_[1][i], axes_[2][i]});
      worth_[i] = options_.objective == TeachingObjective::kRegret ? -table.component(cell, component).regret
                                                                   : table.tests_right(cell, component);
    }
    return;
  }
  std::vector<std::span<const double>> points(axes_.begin(), axes_.end());
  worth_ = cache.tests_of(component)->share_right(points);
}

const UnitValue::Factors& UnitValue::factors(ConstraintIndex c) {
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
      known.shown[i] = std::exp(part.shown.log_relative(t[i]));
      known.feedback[i] = std::exp(part.feedback.log_relative(t[i]));
    }
  }
  return known;
}

void UnitValue::multiply_shown(const ConstraintSet& conveyed) {
  for (const auto c : conveyed.members()) multiply(product_, factors(c).shown);
}

double UnitValue::of(std::span<const ConstraintSet> shown, const ConstraintSet& taught) {
  if (shown.empty()) {
    product_ = mass_;
  } else {
    const auto before = shown.first(shown.size() - 1);
    if (product_before_.empty() || !std::equal(before.begin(), before.end(), before_.begin(), before_.end())) {
      product_ = mass_;
      for (const auto& conveyed : before) multiply_shown(conveyed);
      before_.assign(before.begin(), before.end());
      product_before_ = product_;
    }
    product_ = product_before_;
    multiply_shown(shown.back());
  }

  for (const auto c : taught.members()) multiply(product_, factors(c).feedback);
  std::vector<double> members(num_members_, 0.0);
  std::vector<double> weights(num_members_, 0.0);
  for (const Part& part : parts_) {
    double mass = 0.0;
    double worth = 0.0;
    for (std::size_t i = part.begin; i < part.end; ++i) {
      mass += product_[i];
      worth += product_[i] * worth_[i];
    }
    weights[part.member] += part.weight;
    if (mass > 0.0) members[part.member] += part.weight * (1.0 - part.imitation.probability) * worth / mass;
  }

  double sum = 0.0;
  double worst = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < num_members_; ++i) {
    const double value = members[i] / weights[i];
    sum += value;
    worst = std::min(worst, value);
  }
  if (num_members_ == 0) return 0.0;
  return options_.objective == TeachingObjective::kWorstMember ? worst : sum / static_cast<double>(num_members_);
}

}  // namespace kith
