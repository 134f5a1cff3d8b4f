#include "kith/explain/inspect_json.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "kith/explain/words.hpp"

namespace kith {
namespace {

Json start_to_json(const Atlas& atlas, StartIndex start) {
  const auto& domain = atlas.domain();
  const auto& counts = atlas.feature_counts(start);
  Json json{{"start", start_to_json(domain, atlas.id(start))}};
  json.update(actions_json(domain, atlas.trajectory(start)));
  json["features"] = counts_to_json(domain, counts);
  json["return"] = return_of(domain, counts);
  json["one_step"] = to_json(atlas.constraints().half_spaces(atlas.one_step(start)), domain.num_features());
  json["unique"] = atlas.is_unique(start);
  return json;
}

Json components_to_json(const Atlas& atlas) {
  const auto& domain = atlas.domain();
  Json components = Json::array();
  for (const auto& component : atlas.knowledge_components()) {
    Json masked = Json::array();
    for (const auto k : component.masked) masked.push_back(domain.feature_names()[k]);
    components.push_back(
        {{"name", component.name},
         {"masked", masked},
         {"mdps", std::count(component.uses_mdp.begin(), component.uses_mdp.end(), true)},
         {"constraints", to_json(atlas.constraints().half_spaces(component.constraints), domain.num_features())},
         {"area_sr", component.area_sr}});
  }
  return components;
}

// The map of every MDP, rows from the top; null where that would be too long.
Json maps_to_json(const GridMap& map, std::size_t num_mdps) {
  constexpr std::size_t kMostCells = 1'000'000;
  const auto cells = static_cast<std::size_t>(map.width()) * static_cast<std::size_t>(map.height());
  if (cells * num_mdps > kMostCells) return nullptr;
  Json maps = Json::array();
  for (MdpIndex m{0}; m.value() < num_mdps; ++m) maps.push_back(map.draw(m, std::nullopt));
  return maps;
}

}  // namespace

Json inspection_json(const Domain& domain) {
  const auto d = domain.num_features();
  Json document{{"schema", "kith.inspect/1"},
                {"id", domain.id()},
                {"title", domain.title()},
                {"mdps", domain.num_mdps()},
                {"demonstrations", domain.num_starts()},
                {"features", domain.feature_names()},
                {"actions", domain.action_names()},
                {"weights", {{"raw", domain.weights().raw}, {"unit", to_json(domain.weights().unit)}}},
                {"prior", to_json(domain.prior(), d)}};
  for (MdpIndex m{0}; m.value() < domain.num_mdps(); ++m) {
    if (!domain.world_name(m).empty()) document["mdp_names"][std::to_string(m.value())] = domain.world_name(m);
  }
  if (const auto& inferred = domain.inferred()) {
    document["inferred"] = {{"share", inferred->share},
                            {"loss", inferred->loss},
                            {"margin", inferred->margin},
                            {"left_out", inferred->left_out}};
  }
  if (const auto map = domain.map()) document["maps"] = maps_to_json(*map, domain.num_mdps());
  return document;
}

Json inspection_json(const Atlas& atlas, const InspectionContent& content) {
  const auto& domain = atlas.domain();
  const auto d = domain.num_features();
  auto document = inspection_json(domain);

  document["bec"] = {{"constraints", to_json(atlas.policy_bec_half_spaces(), d)},
                     {"area_sr", atlas.policy_bec_area_sr()},
                     {"area_error", atlas.policy_bec_area().standard_error},
                     {"regret_left", atlas.regret_left() ? Json(*atlas.regret_left()) : Json{}}};
  document["knowledge_components"] = components_to_json(atlas);
  document["mask_counters"] = atlas.mask_counters();

  if (const auto* tables = atlas.find_tables()) {
    const auto& coverage = tables->coverage();
    document["coverage"] = {{"vertices", coverage.vertices}, {"mean", coverage.mean}, {"max", coverage.max}};
    document["policy_cells"] = tables->cells().size();
  }

  if (content.demos) {
    Json demos = Json::array();
    for (std::size_t i = 0; i < atlas.num_states(); ++i) {
      const StartIndex start{i};
      if (!atlas.is_candidate(start)) continue;
      if (!content.mdp || atlas.id(start).mdp.value() == *content.mdp) demos.push_back(start_to_json(atlas, start));
    }
    document["demos"] = std::move(demos);
  }
  return document;
}

}  // namespace kith
