#include "facts.hpp"

#include <algorithm>
#include <ostream>

#include "kith/explain/target.hpp"

namespace kith {

// As failures show it.
void PrintTo(const IntegerVector& v, std::ostream* out) { *out << to_string(v); }

}  // namespace kith

namespace kith::laws {
namespace {

std::vector<std::size_t> features_of(const std::vector<std::size_t>& features, const Counted& counted) {
  std::vector<std::size_t> result;
  for (std::size_t k = 0; k < counted.size(); ++k) {
    if (counted[k] && std::find(features.begin(), features.end(), *counted[k]) != features.end()) result.push_back(k);
  }
  return result;
}

}  // namespace

IntegerVector carried_over(const IntegerVector& v, const Counted& counted) {
  IntegerVector result(counted.size());
  for (std::size_t k = 0; k < counted.size(); ++k) result[k] = counted[k] ? v[*counted[k]] : 0;
  return result;
}

std::vector<IntegerVector> carried_over(const std::vector<HalfSpace>& all, const Counted& counted) {
  std::vector<IntegerVector> result;
  for (const auto& one : all) result.push_back(carried_over(one.normal(), counted));
  std::sort(result.begin(), result.end());
  return result;
}

Facts facts_of(const Atlas& atlas, const Counted& counted) {
  Facts facts;
  facts.num_worlds = atlas.domain().num_mdps();
  for (StartIndex start{0}; start.value() < atlas.num_states(); ++start) {
    if (atlas.is_candidate(start)) facts.counts.push_back(carried_over(atlas.feature_counts(start), counted));
  }
  std::sort(facts.counts.begin(), facts.counts.end());
  facts.region = carried_over(atlas.policy_bec_half_spaces(), counted);
  for (const auto& component : atlas.knowledge_components()) {
    facts.components.push_back(
        {features_of(component.features, counted),
         carried_over(atlas.constraints().half_spaces(component.constraints), counted),
         static_cast<std::size_t>(std::count(component.uses_mdp.begin(), component.uses_mdp.end(), true))});
  }
  std::sort(facts.components.begin(), facts.components.end());
  for (const auto k : counted) facts.mask_counters.push_back(k ? atlas.mask_counters()[*k] : 0);
  return facts;
}

std::vector<IsolationFacts> isolations_of(const Atlas& atlas, const Counted& counted) {
  std::vector<IsolationFacts> all;
  for (const auto& isolated : isolated_constraints(atlas)) {
    all.push_back({carried_over(isolated.constraint.normal(), counted), isolated.teaching, isolated.testing});
  }
  std::sort(all.begin(), all.end());
  return all;
}

void PrintTo(const ComponentFacts& facts, std::ostream* out) {
  *out << "features";
  for (const auto k : facts.features) *out << ' ' << k;
  *out << " in " << facts.num_worlds << " worlds:";
  for (const auto& normal : facts.constraints) *out << ' ' << to_string(normal);
}

void PrintTo(const IsolationFacts& facts, std::ostream* out) {
  *out << to_string(facts.constraint) << " taught by " << facts.teaching << ", tested by " << facts.testing;
}

void PrintTo(const TaughtFacts& facts, std::ostream* out) {
  for (const bool is_taught : {true, false}) {
    *out << (is_taught ? "taught:" : "; skipped:");
    for (const auto& features : is_taught ? facts.taught : facts.skipped) {
      *out << ' ';
      for (const auto k : features) *out << k;
    }
  }
}

Counted identity(const Domain& domain) {
  Counted result;
  for (std::size_t k = 0; k < domain.num_features(); ++k) result.emplace_back(k);
  return result;
}

bool has_equal_counters(const Atlas& atlas) {
  auto counters = atlas.mask_counters();
  std::sort(counters.begin(), counters.end());
  return std::adjacent_find(counters.begin(), counters.end()) != counters.end();
}

std::vector<std::vector<std::size_t>> TaughtFacts::all() const {
  auto result = taught;
  result.insert(result.end(), skipped.begin(), skipped.end());
  std::sort(result.begin(), result.end());
  return result;
}

TaughtFacts taught_facts(const Atlas& atlas, const Curriculum& curriculum, const Counted& counted) {
  TaughtFacts facts;
  std::vector<bool> is_taught(atlas.knowledge_components().size(), false);
  for (const auto& component : curriculum.components) is_taught[component.component] = true;
  for (std::size_t c = 0; c < is_taught.size(); ++c) {
    auto& list = is_taught[c] ? facts.taught : facts.skipped;
    list.push_back(features_of(atlas.knowledge_components()[c].features, counted));
  }
  std::sort(facts.taught.begin(), facts.taught.end());
  std::sort(facts.skipped.begin(), facts.skipped.end());
  return facts;
}

}  // namespace kith::laws
