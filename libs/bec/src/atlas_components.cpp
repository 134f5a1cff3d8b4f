// What there is to learn: the policy's region, and the knowledge components that lead to it.
#include <algorithm>
#include <numeric>

#include "atlas_builder.hpp"
#include "kith/core/text.hpp"
#include "people_regret.hpp"

namespace kith {
namespace {

constexpr std::size_t kMostInOrder = 3;  // features up to which components follow from them alone
constexpr std::size_t kPeople = 32;      // in proportion to whom regret is saved
constexpr std::size_t kFewPeople = 6;    // who know a candidate: no more are too few to tell what it saves
constexpr double kLeastShare = 0.02;     // of the regret before any lesson, for a lesson of its own

}  // namespace

void AtlasBuilder::make_policy_bec() {
  auto all = atlas_.no_constraints();
  for (const auto& set : atlas_.one_step_sets_) all |= set;
  Regions regions{atlas_.constraints_};
  atlas_.policy_bec_ = regions.minimal(all);
  atlas_.policy_bec_half_spaces_ = atlas_.constraints_.half_spaces(atlas_.policy_bec_);
  const auto& region = regions.of(atlas_.policy_bec_ | atlas_.prior_);
  atlas_.policy_bec_area_ = {region.area_sr, region.area_error};
}

void AtlasBuilder::count_masks() {
  const auto d = atlas_.domain_.num_features();
  std::vector<std::vector<std::size_t>> rows(atlas_.one_step_sets_.size(), std::vector<std::size_t>(d, 0));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (const auto c : atlas_.one_step_sets_[i].members()) {
      for (std::size_t k = 0; k < d; ++k) rows[i][k] += atlas_.constraints_[c].normal()[k] != 0 ? 1u : 0u;
    }
  }
  atlas_.mask_counters_.assign(d, 0);
  for (const std::size_t i : candidates()) {
    for (std::size_t k = 0; k < d; ++k) atlas_.mask_counters_[k] += rows[atlas_.starts_[i].one_step][k];
  }
}

// The feature that matters most is the reference. Up to three features, the others are weighed against it one by one,
// those that matter more first, then all together. Of more features, what is weighed follows from the policy's region.
void AtlasBuilder::make_components() {
  const auto& z = atlas_.mask_counters_;
  std::vector<std::size_t> order(z.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  // Among equal counters the step comes first, as the reference.
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return z[a] != z[b] ? z[a] > z[b] : is_before(b, a); });
  const std::size_t reference = order.front();
  order.erase(order.begin());
  std::vector<KnowledgeComponent> parts;
  for (const auto& features : trade_offs(order, reference)) {
    auto part = component(features, reference);
    if (is_of_use(part)) parts.push_back(std::move(part));
  }
  if (z.size() > kMostInOrder) parts = worth_most(std::move(parts));
  for (auto& part : parts) atlas_.components_.push_back(std::move(part));
  atlas_.components_.push_back(component(order, reference));
}

// Each feature against the reference; beyond three features also those that a facet of the policy's region trades
// against each other.
std::vector<std::vector<std::size_t>> AtlasBuilder::trade_offs(const std::vector<std::size_t>& order,
                                                               std::size_t reference) const {
  std::vector<std::vector<std::size_t>> found;
  if (order.size() < 2) return found;
  for (const std::size_t k : order) found.push_back({k});
  if (order.size() + 1 <= kMostInOrder) return found;
  auto facets = atlas_.policy_bec_half_spaces_;
  std::sort(facets.begin(), facets.end(), [&](const auto& a, const auto& b) { return is_before(a, b); });
  for (const auto& facet : facets) {
    std::vector<std::size_t> features;
    for (std::size_t k = 0; k < facet.dimension(); ++k) {
      if (k != reference && facet.normal()[k] != 0) features.push_back(k);
    }
    const bool is_new = std::find(found.begin(), found.end(), features) == found.end();
    if (features.size() > 1 && features.size() < order.size() && is_new) found.push_back(std::move(features));
  }
  return found;
}

// Of all candidates the one by which people who know what was taught before lose least regret per new facet, again and
// again: at most d + 1, as one with everything follows. What saves hardly anything is left to that one.
std::vector<KnowledgeComponent> AtlasBuilder::worth_most(std::vector<KnowledgeComponent> candidates) {
  std::vector<KnowledgeComponent> chosen;
  if (candidates.empty()) return chosen;
  PeopleRegret regret{partitions(), {}};
  Regions regions{atlas_.constraints_};
  auto taught = atlas_.prior_;
  std::optional<double> at_first;
  while (!candidates.empty() && chosen.size() <= atlas_.domain_.num_features()) {
    const Eigen::MatrixXd people = people_within(taught, kPeople);
    std::vector<double> lost;
    for (Eigen::Index i = 0; i < people.cols(); ++i) lost.push_back(regret.of(people.col(i)));
    const double before = std::accumulate(lost.begin(), lost.end(), 0.0) / static_cast<double>(kPeople);
    if (!at_first) at_first = before;

    std::optional<std::size_t> best;
    double most = 0.0;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      const auto after = regions.minimal(taught | candidates[i].constraints);
      const auto num_new = static_cast<double>(after.without(taught).count());
      if (num_new == 0.0) continue;
      const auto known = atlas_.constraints_.half_spaces(candidates[i].constraints);
      double sum = 0.0, inside = 0.0;
      for (std::size_t p = 0; p < lost.size(); ++p) {
        const Direction weights = people.col(static_cast<Eigen::Index>(p));
        const bool knows = std::all_of(known.begin(), known.end(), [&](const auto& h) { return h.contains(weights); });
        sum += knows ? lost[p] : 0.0;
        inside += knows ? 1.0 : 0.0;
      }
      if (inside < static_cast<double>(kFewPeople)) {
        const Eigen::MatrixXd others = people_within(after, kFewPeople);
        for (Eigen::Index p = 0; p < others.cols(); ++p) sum += regret.of(others.col(p));
        inside += static_cast<double>(others.cols());
      }
      const double saved = before - sum / inside;
      if (saved < kLeastShare * *at_first || saved / num_new <= most) continue;
      most = saved / num_new;
      best = i;
    }
    if (!best) break;
    taught = regions.minimal(taught | candidates[*best].constraints);
    chosen.push_back(std::move(candidates[*best]));
    candidates.erase(candidates.begin() + static_cast<std::ptrdiff_t>(*best));
  }
  return chosen;
}

// Whether some world has all of the component's features and none of the masked ones.
bool AtlasBuilder::is_of_use(const KnowledgeComponent& component) const {
  const auto& domain = atlas_.domain_;
  for (MdpIndex m{0}; m.value() < domain.num_mdps(); ++m) {
    const bool has_all = std::all_of(component.features.begin(), component.features.end(),
                                     [&](std::size_t k) { return domain.mdp(m).has_feature(k); });
    if (component.uses_mdp[m.value()] && has_all) return true;
  }
  return false;
}

KnowledgeComponent AtlasBuilder::component(std::vector<std::size_t> features, std::size_t reference) {
  const auto& domain = atlas_.domain_;
  KnowledgeComponent result;
  std::sort(features.begin(), features.end());
  result.features = std::move(features);
  for (const std::size_t k : result.features) {
    result.name += (result.name.empty() ? "" : "+") + domain.feature_names()[k];
  }
  for (std::size_t k = 0; k < domain.num_features(); ++k) {
    const bool is_taught = std::binary_search(result.features.begin(), result.features.end(), k);
    if (k != reference && !is_taught) result.masked.push_back(k);
  }
  for (MdpIndex m{0}; m.value() < domain.num_mdps(); ++m) {
    result.uses_mdp.push_back(std::none_of(result.masked.begin(), result.masked.end(),
                                           [&](std::size_t k) { return domain.mdp(m).has_feature(k); }));
  }
  auto all = atlas_.no_constraints();
  for (const std::size_t i : candidates()) {
    const auto& start = atlas_.starts_[i];
    if (result.uses_mdp[start.id.mdp.value()]) all |= atlas_.one_step_sets_[start.one_step];
  }
  Regions regions{atlas_.constraints_};
  result.constraints = regions.minimal(all);
  const auto& region = regions.of(result.constraints | atlas_.prior_);
  result.area_sr = region.area_sr;
  result.area_error = region.area_error;
  return result;
}

std::size_t reference_feature(const Domain& domain, std::span<const KnowledgeComponent> components) {
  const auto& weighed = components.back().features;
  for (std::size_t k = 0; k < domain.num_features(); ++k) {
    if (std::ranges::find(weighed, k) == weighed.end()) return k;
  }
  return domain.num_features() - 1;
}

std::string masked_names(const Domain& domain, const KnowledgeComponent& component) {
  return listed(
      component.masked, [&](std::size_t k) { return domain.feature_names()[k]; }, " or ");
}

}  // namespace kith
