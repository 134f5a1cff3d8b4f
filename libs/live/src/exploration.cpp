#include "exploration.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numeric>
#include <utility>

#include "kith/core/error.hpp"
#include "kith/domains/domain_file.hpp"
#include "kith/domains/variation.hpp"
#include "kith/explain/board_json.hpp"
#include "kith/explain/contrast.hpp"
#include "kith/live/world_json.hpp"
#include "live_texts.hpp"
#include "message_json.hpp"
#include "room_view.hpp"

namespace kith {
namespace {

constexpr int kMostColumns = 12;  // of a map that pages draw in full size
constexpr std::size_t kMostStates = 4000;

Exploration impossible() { return {{true, {}}, {}}; }

std::optional<Cell> cell_of(const Json& json, const GridMap& map) {
  const auto place = read_within<std::vector<std::int64_t>>(json, {.least = 1});
  if (!place || place->size() != 2) return std::nullopt;
  const auto column = place->front(), row = place->back();
  if (column > map.width() || row > map.height()) return std::nullopt;
  return Cell{static_cast<int>(column), map.height() + 1 - static_cast<int>(row)};
}

// The state of a frame; nothing if the world has none like it.
std::optional<StateIndex> state_of(const GridMap& map, MdpIndex world, const Json& frame) {
  if (!frame.is_object()) return std::nullopt;
  GridState state;
  const auto robot = cell_of(frame.value("robot", Json{}), map);
  if (!robot) return std::nullopt;
  state.robot = *robot;
  const auto items = frame.value("items", Json::array());
  for (const auto item : map.items_in(world)) {
    const auto given = std::find_if(items.begin(), items.end(), [&](const Json& one) {
      return one.is_object() && one.value("name", Json{}) == map.item_names()[item];
    });
    if (given == items.end()) return std::nullopt;
    const auto cell = cell_of(given->value("cell", Json{}), map);
    if (!cell) return std::nullopt;
    const bool is_carried = given->value("carried", Json{}) == true;
    state.items.push_back(is_carried ? *robot : *cell);
    state.carried.push_back(is_carried);
  }
  for (const auto& station : frame.value("stations", Json::array())) {
    const auto cell = cell_of(station, map);
    if (!cell) return std::nullopt;
    state.stations.push_back(*cell);
  }
  std::sort(state.stations.begin(), state.stations.end(), [](const Cell& a, const Cell& b) {
    return std::pair{-a.y, a.x} < std::pair{-b.y, b.x};
  });
  return map.find_state(world, state);
}

// The robot's path beside the best one that trades something for something else, as people may have expected it.
std::optional<Contrast> trade(const Atlas& atlas, StartIndex start) {
  if (atlas.find_tables() == nullptr) return std::nullopt;
  return best_contrast(atlas, start, [&](const Contrast& one) { return !is_detour(atlas.domain(), one); });
}

Exploration explored_in(const Atlas& atlas, MdpIndex world, const Json& start) {
  const auto& domain = atlas.domain();
  const auto map = domain.drawing();
  const auto state = map ? state_of(*map, world, start) : std::nullopt;
  if (!state || state->value() >= domain.mdp(world).num_states()) return impossible();
  return explored(atlas, atlas.index({world, *state}));
}

// Whether the map can be changed, too: a domain file with the rows of one.
bool can_change_map(const LiveStudy& study) {
  const auto& domain = study.atlas->domain();
  const auto map = domain.map();
  if (!map || map->is_picture() || study.domain_text.empty()) return false;
  return with_one_map(study.domain_text, domain.id(), map->draw(MdpIndex{domain.num_mdps() - 1}, std::nullopt))
      .has_value();
}

}  // namespace

bool can_explore(const Domain& domain) {
  const auto map = domain.drawing();
  return map && map->width() <= kMostColumns && map->height() <= kMostColumns;
}

std::vector<std::string> placeable_symbols(const LiveStudy& study) {
  std::vector<std::string> symbols;
  if (!can_change_map(study)) return symbols;
  for (const auto& entry : study.atlas->domain().map()->legend()) {
    if (entry.start || !entry.item.empty() || entry.content.goal || !entry.content.destination_of.empty()) continue;
    symbols.emplace_back(1, entry.symbol);
  }
  return symbols;
}

Json known_brackets(const Atlas& atlas, const std::vector<HalfSpace>& more, std::vector<std::size_t> features) {
  const auto& domain = atlas.domain();
  auto known = domain.prior();
  known.insert(known.end(), more.begin(), more.end());
  const auto reference = reference_feature(domain, atlas.knowledge_components());
  if (features.empty()) {
    features.resize(domain.num_features());
    std::iota(features.begin(), features.end(), std::size_t{0});
    std::erase(features, reference);
  }
  return brackets_json(domain, brackets(domain, known, features, reference));
}

Json playground_json(const LiveStudy& study, const Json& asked) {
  const auto& atlas = *study.atlas;
  std::vector<HalfSpace> all;
  for (const auto& component : atlas.knowledge_components()) {
    for (auto& half_space : atlas.constraints().half_spaces(component.conveyed.value_or(component.constraints)))
      all.push_back(std::move(half_space));
  }
  Json page{{"learn", known_brackets(atlas, all)}, {"explore", Json{}}};
  if (!can_explore(atlas.domain())) return page;
  const MdpIndex world{atlas.domain().num_mdps() - 1};  // everything optional is there
  auto now = explored(atlas, atlas.index({world, atlas.domain().initial_state(world)}));
  view::Explore shown{now.shown, placeable_symbols(study), Json{}, std::nullopt};
  if (!asked.is_null()) {
    const auto map = asked.value("map", std::vector<std::string>{});
    now = map.empty() ? explored_in(atlas, world, asked.at("start"))
                      : explored(study, {asked.at("start"), std::nullopt, map});
    shown.at<"last">() = now.shown;
  }
  shown.at<"brackets">() = known_brackets(atlas, now.conveyed);
  page["explore"] = written(shown);
  return page;
}

Exploration explored(const Atlas& atlas, StartIndex start) {
  const auto& domain = atlas.domain();
  const auto world = atlas.id(start).mdp;
  auto robot = expected_path(atlas, start);
  view::Found found;
  found.at<"board">() = live_board(board_legend(domain), atlas, start);
  if (const auto contrast = trade(atlas, start)) {
    found.at<"other">() = path_json(domain, world, contrast->alternative);
    found.at<"differs_at">() = contrast->decisive;
    found.at<"reason">() = sentence(reason(atlas, *contrast));
    found.at<"tie">() = dot(domain.weights().integer, contrast->robot_counts - contrast->alternative_counts) == 0;
    robot = contrast->robot;
  }
  found.at<"path">() = path_json(domain, world, robot);
  Exploration result{{false, std::move(found)}, {}};
  if (!atlas.is_candidate(start)) return result;
  for (auto& half_space : atlas.constraints().half_spaces(atlas.one_step(start))) {
    if (sign_of_dot(domain.weights().integer, half_space.normal()) > 0)
      result.conveyed.push_back(std::move(half_space));
  }
  return result;
}

Exploration explored(const LiveStudy& study, const happening::Explored& asked) try {
  if (asked.world) return explored_in(*study.atlas, MdpIndex{*asked.world}, asked.start);
  const auto& id = study.atlas->domain().id();
  const auto text = with_one_map(study.domain_text, id, asked.map);
  if (!text) return impossible();
  auto reading = parse_domain(*text, id, {.max_states = kMostStates});
  if (!reading.domain) return impossible();
  return explored_in(Atlas{*std::move(reading.domain)}, MdpIndex{0}, asked.start);
} catch (const Error&) {
  return impossible();  // the robot has no finite optimum there
}

}  // namespace kith
