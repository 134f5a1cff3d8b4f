#include "kith/explain/picture.hpp"

#include <algorithm>

#include "kith/explain/legend.hpp"
#include "kith/explain/words.hpp"
#include "kith/explain/wrapped.hpp"
#include "kith/mdp/behaviour.hpp"

namespace kith {
namespace {

char arrow_of(const std::string& action) {
  if (action == "up") return '^';
  if (action == "down") return 'v';
  if (action == "left") return '<';
  if (action == "right") return '>';
  return action.front();
}

char& at(Picture& picture, const Cell& cell) {
  return picture[picture.size() - static_cast<std::size_t>(cell.y)][static_cast<std::size_t>(cell.x - 1)];
}

// Whether only the robot is elsewhere.
bool same_things(const GridState& a, const GridState& b) {
  for (std::size_t i = 0; i < a.items.size(); ++i) {
    if (a.carried[i] != b.carried[i] || (!a.carried[i] && a.items[i] != b.items[i])) return false;
  }
  return a.stations == b.stations;
}

}  // namespace

GridState with_robot_at(GridState state, const Cell& cell) {
  state.robot = cell;
  for (std::size_t i = 0; i < state.items.size(); ++i) {
    if (state.carried[i]) state.items[i] = cell;
  }
  return state;
}

std::vector<GridState> configurations_on(const Domain& domain, const GridMap& map, MdpIndex m, const Trajectory& path) {
  std::vector<GridState> seen;
  for (const auto s : path.states) {
    if (domain.mdp(m).is_terminal(s)) continue;
    const auto now = map.state(m, s);
    if (std::none_of(seen.begin(), seen.end(), [&](const auto& other) { return same_things(now, other); })) {
      seen.push_back(now);
    }
  }
  return seen;
}

std::string configuration_in_words(const GridMap& map, MdpIndex m, const GridState& state) {
  std::string text;
  const auto names = map.items_in(m);
  for (std::size_t i = 0; i < state.items.size(); ++i) {
    const auto& name = map.item_names()[names[i]];
    text += (state.carried[i] ? "carrying " + name : name + " at " + cell_text(map, state.items[i])) + ", ";
  }
  if (!map.is_picture()) return text + counted(state.stations.size(), "station") + " left";
  return text.substr(0, text.size() - std::min<std::size_t>(2, text.size()));
}

Picture start_picture(const GridMap& map, StartId id) { return map.draw(id.mdp, id.start); }

std::vector<Picture> path_pictures(const Domain& domain, const GridMap& map, StartId id, const Trajectory& path) {
  const auto robot = [&](std::size_t i) { return map.state(id.mdp, path.states[i]).robot; };
  std::vector<Picture> legs;
  Picture leg;
  std::size_t moves = 0;
  std::vector<Cell> left;  // in this leg
  for (std::size_t i = 0; i < path.actions.size(); ++i) {
    if (leg.empty()) leg = start_picture(map, StartId{id.mdp, path.states[i]});
    if (robot(i) != robot(i + 1)) {
      at(leg, robot(i)) = arrow_of(domain.action_names()[path.actions[i].value()]);
      left.push_back(robot(i));
      ++moves;
    }
    const bool ends = robot(i) == robot(i + 1) || i + 1 == path.actions.size();
    if (!ends) continue;
    const bool goes_on = i + 1 == path.actions.size() && path.repeats_from &&
                         std::find(left.begin(), left.end(), robot(i + 1)) != left.end();
    if (!goes_on) at(leg, robot(i + 1)) = 'o';
    if (moves > 0) legs.push_back(std::move(leg));
    leg.clear();
    left.clear();
    moves = 0;
  }
  return legs;
}

std::string path_text(const Domain& domain, StartId id, const Trajectory& path, std::size_t indent) {
  const std::string blank(indent, ' ');
  std::string text = blank + domain.state_name(id.mdp, path.states.front()) + "\n";
  for (std::size_t i = 0; i < path.actions.size(); ++i) {
    text += blank + "  " + domain.action_names()[path.actions[i].value()] + " -> " +
            domain.state_name(id.mdp, path.states[i + 1]) + "\n";
  }
  return text;
}

std::string start_and_path(const Domain& domain, StartId id, const Trajectory& path, std::size_t indent) {
  const auto map = domain.drawing();
  if (!map) return path_text(domain, id, path, indent);
  std::vector<Picture> pictures{bare_picture(*map, id), start_picture(*map, id)};
  for (auto& leg : path_pictures(domain, *map, id, path)) pictures.push_back(std::move(leg));
  return beside(pictures, indent);
}

namespace {

// By likeliest outcomes that change the state.
Trajectory likeliest_path(const Mdp& mdp, std::span<const std::uint32_t> choice, StateIndex start) {
  Trajectory path{{start}, {}};
  std::vector<std::size_t> step_of(mdp.num_states(), mdp.num_states());  // that many: none
  for (auto s = start; !mdp.is_terminal(s); s = path.states.back()) {
    if (step_of[s.value()] < path.actions.size()) {
      path.repeats_from = step_of[s.value()];
      break;
    }
    step_of[s.value()] = path.actions.size();
    const auto& taken = mdp.choices(s)[choice[s.value()]];
    const auto chance = [&](const Outcome& outcome) { return outcome.next == s ? 0.0 : outcome.probability; };
    path.actions.push_back(taken.action);
    path.states.push_back(std::ranges::max_element(mdp.outcomes(taken), {}, chance)->next);
  }
  return path;
}

}  // namespace

std::optional<DrawnPolicy> policy_to_draw(const Domain& domain, MdpIndex m) {
  const auto& mdp = domain.mdp(m);
  if (is_exact(mdp)) {
    auto solution = plan_exactly(mdp, domain.weights().integer).solution.value();
    auto path = canonical_trajectory(mdp, solution.canonical_choice, domain.initial_state(m));
    return DrawnPolicy{std::move(solution.canonical_choice), std::move(path)};
  }
  auto behaviour = behave(mdp, domain.weights().raw, {.scale = domain.count_scale()});
  if (!behaviour) return std::nullopt;
  auto path = likeliest_path(mdp, behaviour->choice, domain.initial_state(m));
  return DrawnPolicy{std::move(behaviour->choice), std::move(path)};
}

Picture policy_picture(const Domain& domain, const GridMap& map, MdpIndex m, std::span<const std::uint32_t> choice,
                       const GridState& configuration) {
  auto picture = map.draw(m, std::nullopt);
  for (int y = 1; y <= map.height(); ++y) {
    for (int x = 1; x <= map.width(); ++x) {
      const Cell cell{x, y};
      const auto state = map.find_state(m, with_robot_at(configuration, cell));
      if (!state || domain.mdp(m).is_terminal(*state)) continue;
      const auto action = domain.mdp(m).choices(*state)[choice[state->value()]].action;
      at(picture, cell) = arrow_of(domain.action_names()[action.value()]);
    }
  }
  return picture;
}

std::string beside(const std::vector<Picture>& pictures, std::size_t indent) {
  // As many in a row as fit, with a blank line between rows.
  constexpr std::size_t kBetween = 4;
  const std::size_t width = pictures.front().front().size() + kBetween;
  const std::size_t fit = std::max<std::size_t>(1, (kTextWidth - std::min(indent, kTextWidth) + kBetween) / width);
  std::string text;
  for (std::size_t first = 0; first < pictures.size(); first += fit) {
    if (first > 0) text += "\n";
    for (std::size_t row = 0; row < pictures.front().size(); ++row) {
      std::string line(indent, ' ');
      for (std::size_t i = first; i < std::min(first + fit, pictures.size()); ++i) {
        line += (i > first ? std::string(kBetween, ' ') : "") + pictures[i][row];
      }
      line.erase(line.find_last_not_of(' ') + 1);
      text += line + "\n";
    }
  }
  return text;
}

}  // namespace kith
