#include "kith/explain/board_json.hpp"

#include <string>
#include <vector>

#include "kith/explain/move_table.hpp"
#include "kith/explain/surfaces.hpp"
#include "kith/explain/words.hpp"

namespace kith {
namespace {

Json cell_json(const GridMap& map, const Cell& cell) { return Json::array({cell.x, map.height() + 1 - cell.y}); }

struct Kind {
  std::string kind, name;
};

// All that a symbol puts on a cell.
std::vector<Kind> parts_of(const LegendEntry& entry) {
  std::vector<Kind> parts;
  if (entry.content.wall) parts.push_back({"wall", "wall"});
  if (!entry.content.terrain.empty()) parts.push_back({"terrain", entry.content.terrain});
  if (!entry.station.empty()) parts.push_back({"station", entry.station});
  if (!entry.content.destination_of.empty()) {
    parts.push_back({"destination", "destination of " + entry.content.destination_of});
  }
  if (entry.content.goal) parts.push_back({"goal", entry.goal_name.empty() ? "goal" : entry.goal_name + " goal"});
  if (entry.start) parts.push_back({"start", "start"});
  if (!entry.item.empty()) parts.push_back({"item", entry.item});
  return parts;
}

Json frame_json(const Domain& domain, MdpIndex world, StateIndex s) {
  const auto map = domain.drawing();
  if (!map) return {{"state", domain.state_name(world, s)}};
  const auto state = map->state(world, s);
  const auto names = map->items_in(world);
  Json items = Json::array();
  for (std::size_t i = 0; i < state.items.size(); ++i) {
    items.push_back({{"name", map->item_names()[names[i]]},
                     {"cell", cell_json(*map, state.items[i])},
                     {"carried", bool{state.carried[i]}}});
  }
  Json stations = Json::array();
  for (const auto& station : state.stations) stations.push_back(cell_json(*map, station));
  return {{"robot", cell_json(*map, state.robot)}, {"items", items}, {"stations", stations}};
}

Json ratio_json(const std::optional<Ratio>& ratio) {
  return ratio ? Json::array({ratio->numerator, ratio->denominator}) : Json{};
}

// What a step of a path counts.
Json step_counts(const Mdp& mdp, const Trajectory& path, std::size_t t) {
  for (const auto& choice : mdp.choices(path.states[t])) {
    if (choice.action != path.actions[t]) continue;
    for (const auto& outcome : mdp.outcomes(choice)) {
      if (outcome.next == path.states[t + 1]) return counts_json(mdp, outcome);
    }
  }
  return nullptr;
}

}  // namespace

Json board_domain_json(const Domain& domain) {
  Json features = Json::array();
  for (std::size_t k = 0; k < domain.num_features(); ++k) {
    const auto& wording = domain.wording(k);
    features.push_back({{"name", domain.feature_names()[k]},
                        {"words", domain.feature_words(k)},
                        {"weight", domain.weights().raw[k]},
                        {"many", wording.many},
                        {"do", wording.do_one},
                        {"do_many", wording.do_many}});
  }
  Json counted = Json::array();
  for (std::size_t k = 0; k < domain.num_features(); ++k) {
    const auto& wording = domain.wording(k);
    const auto words = counted_as(wording);
    counted.push_back({{"name", domain.feature_names()[k]},
                       {"label", in_general(wording)},
                       {"one", words.one},
                       {"many", words.many}});
  }
  Json json{{"id", domain.id()}, {"title", domain.title()}, {"features", features}, {"counted", counted}};
  if (auto job = job_in_words(domain); !job.empty()) json["job"] = std::move(job);
  const auto map = domain.drawing();
  if (!map) return json;
  Json legend = Json::array();
  for (const auto& entry : map->legend()) {
    const auto kinds = parts_of(entry);
    if (kinds.empty()) continue;  // floor
    Json parts = Json::array();
    for (const auto& [kind, name] : kinds) parts.push_back({{"kind", kind}, {"name", name}});
    legend.push_back({{"symbol", std::string{entry.symbol}},
                      {"kind", kinds.front().kind},
                      {"name", kinds.front().name},
                      {"parts", parts}});
  }
  Json surfaces = Json::array();
  for (const auto& surface : surfaces_of(*map)) {
    surfaces.push_back({{"name", surface.name}, {"tint", surface.tint}, {"pattern", surface.pattern}});
  }
  json["legend"] = legend;
  json["surfaces"] = surfaces;
  json["width"] = map->width();
  json["height"] = map->height();
  return json;
}

Json board_json(const Domain& domain, StartId id) {
  Json json{{"world", id.mdp.value()}};
  const auto map = domain.drawing();
  if (map) json["map"] = map->draw(id.mdp, std::nullopt);
  const auto fences = map ? map->fences(id.mdp) : std::vector<std::pair<Cell, Cell>>{};
  for (const auto& [a, b] : fences) json["fences"].push_back({cell_json(*map, a), cell_json(*map, b)});
  const auto name = domain.world_name(id.mdp);
  if (!name.empty()) json["world_name"] = name;
  json["start"] = frame_json(domain, id.mdp, id.start);
  return json;
}

Json frames_json(const Domain& domain, MdpIndex world, const Trajectory& path) {
  Json frames = Json::array();
  for (std::size_t t = 0; t < path.states.size(); ++t) {
    auto frame = frame_json(domain, world, path.states[t]);
    frame["action"] = nullptr;
    if (t < path.actions.size()) {
      frame["action"] = domain.action_names()[path.actions[t].value()];
      frame["counts"] = step_counts(domain.mdp(world), path, t);
    }
    frames.push_back(std::move(frame));
  }
  return frames;
}

Json path_json(const Domain& domain, MdpIndex world, const Trajectory& path) {
  Json json{{"frames", frames_json(domain, world, path)}};
  if (path.repeats_from) {
    json["repeats_from"] = *path.repeats_from;
    json["repeats_text"] = never_in_words(domain, world, path);
  }
  return json;
}

Json step_json(const Domain& domain, MdpIndex world, const Trajectory& path, std::size_t step) {
  Json json{{"frame", step}};
  if (const auto map = domain.drawing()) json["cell"] = cell_json(*map, map->state(world, path.states[step]).robot);
  return json;
}

Json sentences_json(const Domain& domain, std::span<const HalfSpace> half_spaces) {
  Json sentences = Json::array();
  const auto texts = each_in_words(domain, half_spaces);
  for (std::size_t i = 0; i < half_spaces.size(); ++i) {
    Json normal = Json::array();
    for (std::size_t k = 0; k < domain.num_features(); ++k) normal.push_back(half_spaces[i].normal()[k]);
    sentences.push_back({{"normal", normal}, {"text", texts[i]}});
  }
  return sentences;
}

Json brackets_json(const Domain& domain, std::span<const Bracket> brackets) {
  Json all = Json::array();
  for (const auto& bracket : brackets) {
    all.push_back({{"feature", bracket.feature},
                   {"reference", bracket.reference},
                   {"low", ratio_json(bracket.low)},
                   {"high", ratio_json(bracket.high)},
                   {"ends", {ends_of(domain, bracket).from, ends_of(domain, bracket).to}},
                   {"text", bracket_in_words(domain, bracket)}});
  }
  return all;
}

Json runs_json(const Domain& domain, MdpIndex world, const std::vector<PolicyRun>& runs) {
  if (runs.empty()) return nullptr;
  Json all = Json::array();
  for (const auto& run : typical_runs(runs)) {
    all.push_back({{"frames", frames_json(domain, world, run.path)}, {"ended", run.has_ended}});
  }
  return {{"text", runs_in_words(domain, world, runs)}, {"runs", std::move(all)}};
}

}  // namespace kith
