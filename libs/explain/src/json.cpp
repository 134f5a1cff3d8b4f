#include "kith/explain/json.hpp"

#include <nlohmann/json.hpp>

namespace kith {
namespace {

// Column and row, row 1 on top.
Json position_json(const GridMap& map, const Cell& cell) { return Json::array({cell.x, map.height() + 1 - cell.y}); }

}  // namespace

Json to_json(const Diagnostic& diagnostic) {
  const auto known = [](std::size_t number) { return number == 0 ? Json{} : Json(number); };
  return {{"id", diagnostic.id},
          {"message", diagnostic.message},
          {"file", diagnostic.file.empty() ? Json{} : Json(diagnostic.file)},
          {"line", known(diagnostic.line)},
          {"column", known(diagnostic.column)},
          {"hint", diagnostic.hint}};
}

Json error_document(const std::vector<Diagnostic>& diagnostics) {
  Json errors = Json::array();
  for (const auto& diagnostic : diagnostics) {
    if (diagnostic.severity == Severity::kError) errors.push_back(to_json(diagnostic));
  }
  return {{"schema", "kith.error/1"}, {"errors", errors}};
}

Json to_json(const IntegerVector& v) {
  Json array = Json::array();
  for (const auto entry : v) array.push_back(entry);
  return array;
}

Json counts_to_json(const Domain& domain, const IntegerVector& counts) {
  if (domain.count_scale() == 1) return to_json(counts);
  Json array = Json::array();
  for (const auto count : counts)
    array.push_back(static_cast<double>(count) / static_cast<double>(domain.count_scale()));
  return array;
}

Json actions_json(const Domain& domain, const Trajectory& path) {
  Json actions = Json::array();
  for (const auto action : path.actions) actions.push_back(domain.action_names()[action.value()]);
  Json json{{"actions", std::move(actions)}};
  if (path.repeats_from) json["repeats_from"] = *path.repeats_from;
  return json;
}

Json to_json(const Direction& v) {
  Json array = Json::array();
  for (const double entry : v) array.push_back(entry);
  return array;
}

Json to_json(std::span<const HalfSpace> half_spaces, std::size_t dimension) {
  Json array = Json::array();
  for (const auto& half_space : half_spaces) {
    Json normal = Json::array();
    for (std::size_t k = 0; k < dimension; ++k) normal.push_back(half_space.normal()[k]);
    array.push_back(normal);
  }
  return array;
}

Json start_to_json(const Domain& domain, StartId id) {
  const auto map = domain.map();
  if (!map) {
    return {{"state", id.start.value()},
            {"name", domain.state_name(id.mdp, id.start)},
            {"mdp", id.mdp.value()},
            {"start", id.start.value()}};
  }
  const auto& state = map->state(id.mdp, id.start);
  const auto names = map->items_in(id.mdp);
  Json items = Json::array();
  Json stations = Json::array();
  for (std::size_t i = 0; i < state.items.size(); ++i) {
    items.push_back({{"name", map->item_names()[names[i]]},
                     {"cell", position_json(*map, state.items[i])},
                     {"carried", bool{state.carried[i]}}});
  }
  for (const auto& station : state.stations) stations.push_back(position_json(*map, station));
  return {{"robot", position_json(*map, state.robot)},
          {"items", items},
          {"stations", stations},
          {"mdp", id.mdp.value()},
          {"start", id.start.value()}};
}

}  // namespace kith
