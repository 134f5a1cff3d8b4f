// What there is to learn: the policy's region, and the knowledge components that lead to it.
#include <algorithm>
#include <numeric>

#include "atlas_builder.hpp"

namespace kith {

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
    for (std::size_t k = 0; k < d; ++k) atlas_.mask_counters_[k] += rows[atlas_.demos_[i].one_step][k];
  }
}

// The feature that matters most is the reference. The others are weighed against it one by one, those that matter more
// first, then two by two, where some world has just these, then all together.
void AtlasBuilder::make_components() {
  const auto& z = atlas_.mask_counters_;
  std::vector<std::size_t> order(z.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  // Among equal counters the later feature comes first; the first is the reference, as the step is last.
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return z[a] != z[b] ? z[a] > z[b] : a > b; });
  const std::size_t reference = order.front();
  order.erase(order.begin());
  if (order.size() > 1) {
    for (const std::size_t k : order) add_if_of_use(component({k}, reference));
  }
  for (std::size_t i = 0; i < order.size() && order.size() > 2; ++i) {
    for (std::size_t j = i + 1; j < order.size(); ++j) {
      add_if_of_use(component({order[i], order[j]}, reference));
    }
  }
  atlas_.components_.push_back(component(order, reference));
}

// If some world has all of the component's features and none of the masked ones.
void AtlasBuilder::add_if_of_use(KnowledgeComponent component) {
  const auto& domain = atlas_.domain_;
  for (MdpIndex m{0}; m.value() < domain.num_mdps(); ++m) {
    const bool has_all = std::all_of(component.features.begin(), component.features.end(),
                                     [&](std::size_t k) { return domain.has_feature(m, k); });
    if (!component.uses_mdp[m.value()] || !has_all) continue;
    atlas_.components_.push_back(std::move(component));
    return;
  }
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
                                           [&](std::size_t k) { return domain.has_feature(m, k); }));
  }
  auto all = atlas_.no_constraints();
  for (const std::size_t i : candidates()) {
    const auto& demo = atlas_.demos_[i];
    if (result.uses_mdp[demo.id.mdp.value()]) all |= atlas_.one_step_sets_[demo.one_step];
  }
  Regions regions{atlas_.constraints_};
  result.constraints = regions.minimal(all);
  const auto& region = regions.of(result.constraints | atlas_.prior_);
  result.area_sr = region.area_sr;
  result.area_error = region.area_error;
  return result;
}

std::string masked_names(const Domain& domain, const KnowledgeComponent& component) {
  std::string text;
  for (std::size_t i = 0; i < component.masked.size(); ++i) {
    if (i > 0) text += i + 1 == component.masked.size() ? " or " : ", ";
    text += domain.feature_names()[component.masked[i]];
  }
  return text;
}

}  // namespace kith
